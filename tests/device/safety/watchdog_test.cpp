#include "device/safety/watchdog.hpp"

#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <condition_variable>
#include <optional>
#include <stdexcept>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

/// Time in steps of the test: each lets the watchdog look once.
class SteppedTime final : public device::WatchdogTime {
 public:
  [[nodiscard]] Time now() noexcept override {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  void pause(Time) noexcept override {
    std::unique_lock lock(mutex_);
    ++pauses_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return granted_ > 0 || over_; });
    if (granted_ > 0) --granted_;
  }

  /// Lets one pause of the watchdog last this long; returns when it has looked.
  void step(Time length) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return pauses_ > steps_; });
    now_ += length;
    ++steps_;
    ++granted_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return pauses_ > steps_; });
  }
  void end() {
    const std::lock_guard lock(mutex_);
    over_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Time now_{};
  int pauses_ = 0;
  int steps_ = 0;
  int granted_ = 0;
  bool over_ = false;
};

struct Watched {
  Watched() = default;
  ~Watched() {
    time.end();
    watchdog.reset();
  }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

  /// Looks every 2 ms, with or without beats of the servo between.
  void pass(milliseconds length, bool beats) {
    for (milliseconds at{0}; at < length; at += milliseconds(2)) {
      if (beats) heartbeat.fetch_add(2);
      time.step(milliseconds(2));
    }
  }
  [[nodiscard]] bool is_stopped() const { return device.halts > 0 && control.stall_requested(); }

  RestingDevice device;
  device::ServoControl control;
  std::atomic<std::int64_t> heartbeat{0};
  SteppedTime time;
  std::optional<device::Watchdog> watchdog{std::in_place, device,           control,
                                           heartbeat,     milliseconds(10), time};
};

TEST_CASE("a watchdog halts the device of a servo that has been silent for 10 ms") {
  Watched watched;
  watched.watchdog->arm();
  watched.pass(milliseconds(50), true);
  watched.pass(milliseconds(8), false);
  CHECK(watched.device.halts == 0);
  watched.pass(milliseconds(2), false);
  CHECK(watched.is_stopped());
  watched.pass(milliseconds(50), false);
  CHECK(watched.device.halts == 1);
  CHECK(watched.watchdog->disarm());
}

TEST_CASE("a watchdog leaves a beating servo alone, even if a beat is late") {
  Watched watched;
  watched.watchdog->arm();
  for (int i = 0; i < 20; ++i) {
    watched.pass(milliseconds(2), true);
    watched.pass(milliseconds(8), false);
  }
  CHECK_FALSE(watched.is_stopped());
  CHECK_FALSE(watched.watchdog->disarm());
}

TEST_CASE("a watchdog waits for the first beat, and stops at the end of a run") {
  Watched watched;
  watched.watchdog->arm();
  watched.pass(milliseconds(100), false);
  CHECK_FALSE(watched.is_stopped());
  watched.pass(milliseconds(10), true);
  watched.heartbeat.store(device::kServoAtRest);
  watched.pass(milliseconds(100), false);
  CHECK_FALSE(watched.is_stopped());
}

TEST_CASE("a watchdog that is not armed watches nothing, and starts again when it is armed") {
  Watched watched;
  watched.pass(milliseconds(10), true);
  watched.pass(milliseconds(100), false);
  CHECK_FALSE(watched.is_stopped());
  watched.watchdog->arm();
  watched.pass(milliseconds(10), true);
  CHECK_FALSE(watched.watchdog->disarm());
  watched.pass(milliseconds(100), false);
  CHECK_FALSE(watched.is_stopped());
}

TEST_CASE("to the watchdog a pause of the whole machine is no silence of the servo") {
  Watched watched;
  watched.watchdog->arm();
  watched.pass(milliseconds(10), true);
  watched.time.step(milliseconds(46));
  CHECK_FALSE(watched.is_stopped());
  watched.pass(milliseconds(2), true);
  watched.time.step(milliseconds(46));
  CHECK_FALSE(watched.is_stopped());
  watched.time.step(milliseconds(46));
  watched.time.step(milliseconds(46));
  CHECK(watched.is_stopped());
}

TEST_CASE("a run whose callback stands still ends as stalled, on the system's clock") {
  RestingDevice device;
  device::ServoControl control;
  std::atomic<std::int64_t> heartbeat{0};
  device::Watchdog watchdog(device, control, heartbeat, milliseconds(50));
  // Stands still at a tick until the watchdog has seen it.
  ForceBy force([&control](const device::DeviceSample& sample) {
    while (sample.sequence == 200 && !control.stall_requested()) std::this_thread::yield();
    return Vec3{0.0, 0.0, 0.4};
  });
  NoSamples sink;
  device::VirtualClock clock;
  device::ServoHooks hooks{.control = &control, .heartbeat = &heartbeat};
  watchdog.arm();
  // The watchdog needs a beat between arming and the stall, which it sees at its next look.
  const device::ServoReport report =
      device::run_servo(device, force, sink, {.limit_ticks = 1'000'000}, clock, hooks);
  CHECK(report.end == device::ServoEnd::fault);
  CHECK(report.fault == device::SafetyFault::stalled);
  CHECK(device.halts == 2);  // by the watchdog, then by the servo at its end
  CHECK(device.written.back() == Vec3{});
  CHECK(heartbeat == device::kServoAtRest);
  CHECK(watchdog.disarm());
}

/// Passes with the servo's beats alone: a servo that waits for a processor is not silent.
class TimeOfBeats final : public device::WatchdogTime {
 public:
  explicit TimeOfBeats(const std::atomic<std::int64_t>& heartbeat) : heartbeat_(heartbeat) {}
  [[nodiscard]] Time now() noexcept override { return milliseconds(heartbeat_.load()); }
  void pause(Time) noexcept override { std::this_thread::yield(); }

 private:
  const std::atomic<std::int64_t>& heartbeat_;
};

TEST_CASE("watchdogs come and go, armed and disarmed, between two threads") {
  RestingDevice device;
  device::ServoControl control;
  std::atomic<std::int64_t> heartbeat{0};
  TimeOfBeats time(heartbeat);
  for (int i = 0; i < 20; ++i) {
    device::Watchdog watchdog(device, control, heartbeat, device::Watchdog::kSilence, time);
    std::thread servo([&] {
      for (int beat = 0; beat < 1000; ++beat) heartbeat.fetch_add(1);
      heartbeat.store(device::kServoAtRest);
    });
    { const device::WatchdogGuard guard(watchdog); }
    servo.join();
  }
  CHECK(device.halts == 0);
}

TEST_CASE("a watchdog is patient where no hand feels a force, and nowhere else") {
  device::DeviceInfo device;
  CHECK(device::Watchdog::silence_for(device) == device::Watchdog::kSilence);
  device.visual = true;
  CHECK(device::Watchdog::silence_for(device) == device::Watchdog::kForcelessSilence);
  device.visual = false;
  device.simulated = true;
  CHECK(device::Watchdog::silence_for(device) == device::Watchdog::kForcelessSilence);
}

TEST_CASE("a watchdog refuses a silence of no length") {
  RestingDevice device;
  device::ServoControl control;
  const std::atomic<std::int64_t> heartbeat{0};
  CHECK_THROWS_AS(device::Watchdog(device, control, heartbeat, milliseconds(0)),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
