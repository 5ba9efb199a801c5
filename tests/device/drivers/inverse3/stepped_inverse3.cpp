#include "device/drivers/inverse3/stepped_inverse3.hpp"

#include <chrono>
#include <thread>

namespace touchtrial::testing {
namespace {

class TestPace final : public device::LinkPace {
 public:
  explicit TestPace(std::shared_ptr<TestTime> time) : time_(std::move(time)) {}
  [[nodiscard]] Time now() noexcept override { return time_ ? time_->load() : Time{}; }
  void rest_until(Time) noexcept override {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }

 private:
  std::shared_ptr<TestTime> time_;
};

device::inverse3::Inverse3Options stepped_by(device::falcon::Lockstep& lockstep) {
  device::inverse3::Inverse3Options options = patient_options();
  options.pace = lockstep.pace();
  return options;
}

}  // namespace

device::inverse3::Inverse3Options patient_options(std::shared_ptr<TestTime> time) {
  device::inverse3::Inverse3Options options;
  options.pace = std::make_unique<TestPace>(std::move(time));
  options.scheduling = {device::SchedulingPolicy::other, 0, false};
  options.timeout = options.answer_timeout = std::chrono::minutes(5);
  return options;
}

PacedInverse3::PacedInverse3(const device::Inverse3Settings& settings)
    : driver(settings, stepped_by(lockstep)) {}

}  // namespace touchtrial::testing
