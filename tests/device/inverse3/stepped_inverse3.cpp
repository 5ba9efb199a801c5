#include "device/inverse3/stepped_inverse3.hpp"

#include <chrono>
#include <thread>
#include <utility>

namespace touchtrial::testing {

struct SteppedInverse3::Steps {
  std::mutex mutex;
  std::condition_variable changed;
  device::ServoClock::Time now{};
  bool resting = false;
  bool may_go = false;
  bool ended = false;
};

class SteppedInverse3::Clock final : public device::ServoClock {
 public:
  explicit Clock(std::shared_ptr<Steps> steps) : steps_(std::move(steps)) {}

  [[nodiscard]] Time now() noexcept override {
    const std::lock_guard lock(steps_->mutex);
    return steps_->now;
  }
  void wait_until(Time time) noexcept override {
    std::unique_lock lock(steps_->mutex);
    steps_->resting = true;
    steps_->changed.notify_all();
    steps_->changed.wait(lock, [&] { return steps_->may_go || steps_->ended; });
    steps_->resting = steps_->may_go = false;
    steps_->now = time;
  }

 private:
  std::shared_ptr<Steps> steps_;
};

namespace {

class TestClock final : public device::ServoClock {
 public:
  explicit TestClock(std::shared_ptr<TestTime> time) : time_(std::move(time)) {}
  [[nodiscard]] Time now() noexcept override { return time_ ? time_->load() : Time{}; }
  void wait_until(Time) noexcept override {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }

 private:
  std::shared_ptr<TestTime> time_;
};

}  // namespace

device::inverse3::Inverse3Options patient_options(std::shared_ptr<TestTime> time) {
  device::inverse3::Inverse3Options options;
  options.clock = std::make_unique<TestClock>(std::move(time));
  options.scheduling = {device::SchedulingPolicy::other, 0, false};
  options.patience = options.silence = std::chrono::minutes(5);
  return options;
}

SteppedInverse3::SteppedInverse3(const device::Inverse3Settings& settings,
                                 std::function<void()> before_read)
    : steps_(std::make_shared<Steps>()), before_read_(std::move(before_read)) {
  device::inverse3::Inverse3Options options = patient_options();
  options.clock = std::make_unique<Clock>(steps_);
  device_ = std::make_unique<device::inverse3::Inverse3Device>(settings, std::move(options));
}

SteppedInverse3::~SteppedInverse3() {
  {
    const std::lock_guard lock(steps_->mutex);
    steps_->ended = true;
  }
  steps_->changed.notify_all();
}

device::DeviceStatus SteppedInverse3::read(device::DeviceSample& sample) noexcept {
  if (before_read_) before_read_();
  step();
  return device_->read(sample);
}

void SteppedInverse3::step() noexcept {
  std::unique_lock lock(steps_->mutex);
  const auto wait_until = [&](auto holds) {
    while (!holds() && device_->fault() == device::DeviceFault::none) {
      steps_->changed.wait_for(lock, std::chrono::milliseconds(1));
    }
  };
  wait_until([&] { return steps_->resting; });
  steps_->may_go = true;
  steps_->changed.notify_all();
  wait_until([&] { return steps_->resting && !steps_->may_go; });
}

}  // namespace touchtrial::testing
