#include "device/servo/servo_thread.hpp"

#include "device/flat_wall.hpp"
#include "device/servo/servo_clock.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <atomic>
#include <future>
#include <stdexcept>
#include <thread>

namespace touchtrial {
namespace {

/// Requests nothing that changes the process of the other tests.
constexpr device::SchedulingRequest kOrdinary{device::SchedulingPolicy::other, 0, false};

TEST_CASE("a servo thread does one piece of work after another on the same thread") {
  device::ServoThread servo(kOrdinary);
  std::thread::id first;
  std::thread::id second;
  servo.run([&] { first = std::this_thread::get_id(); });
  servo.run([&] { second = std::this_thread::get_id(); });
  CHECK(first == second);
  CHECK(first != std::this_thread::get_id());
}

TEST_CASE("a servo thread works while other threads run, and says when it is done") {
  device::ServoThread servo(kOrdinary);
  CHECK_FALSE(servo.running());
  std::promise<void> go;
  servo.start([gone = go.get_future().share()] { gone.wait(); });
  CHECK(servo.running());
  CHECK_THROWS_AS(servo.start([] {}), std::logic_error);
  go.set_value();
  servo.wait();
  CHECK_FALSE(servo.running());
}

TEST_CASE("wait rethrows an exception of the work, and the servo thread continues") {
  device::ServoThread servo(kOrdinary);
  CHECK_THROWS_AS(servo.run([] { throw std::runtime_error("no field"); }), std::runtime_error);
  bool ran = false;
  servo.run([&] { ran = true; });
  CHECK(ran);
}

TEST_CASE("a servo thread that is destroyed ends its work first") {
  std::atomic<bool> ended{false};
  {
    device::ServoThread servo(kOrdinary);
    servo.start([&] { ended = true; });
  }
  CHECK(ended);
}

TEST_CASE("an ordinary thread gets what it requests, without a reason") {
  const device::ServoThread servo(kOrdinary);
  CHECK(servo.scheduling().policy == device::SchedulingPolicy::other);
  CHECK(servo.scheduling().priority == 0);
  CHECK_FALSE(servo.scheduling().memory_locked);
  CHECK(servo.scheduling().reason.empty());
}

TEST_CASE("a thread that requests real time gets it, or the reason and remedy on one line") {
  const device::ServoThread servo({device::SchedulingPolicy::fifo, 1000, false});
  const device::SchedulingObtained& had = servo.scheduling();
  if (had.policy == device::SchedulingPolicy::fifo) {
    CHECK(had.priority == 99);
    CHECK(had.reason.empty());
  } else {
    CHECK(had.priority == 0);
    CHECK(had.reason.find("limits.d") != std::string::npos);
    CHECK(had.reason.find('\n') == std::string::npos);
  }
}

TEST_CASE("the servo on a servo thread never begins a tick before its time") {
  device::ServoThread servo(kOrdinary);
  ScriptedDevice device;
  ConstantForce force({0.0, 0.0, 0.5});
  KeptSamples kept;
  device::PacedClock clock(device::PacedClock::default_spin(servo.scheduling().policy));
  device::ServoReport report;
  const device::ServoClock::Time before = clock.now();
  servo.run([&] {
    report = device::run_servo(device, force, kept, {.limit_ticks = 200, .fade_ticks = 0}, clock);
  });
  REQUIRE_FALSE(kept.samples.empty());
  CHECK(clock.now() - before >= kept.samples.back().tick * device::kServoTick);
  CHECK(report.ticks + report.overruns <= 200);
  CHECK(report.ticks == static_cast<std::int64_t>(kept.samples.size()));
}

TEST_CASE(
    "an exception of the thread that attends to a running servo leaves the hand without force") {
  device::ServoThread thread(kOrdinary);
  device::ServoControl control;
  ScriptedDevice device;
  device::ServoReport report;
  const auto attend = [&] {
    ConstantForce force({0.0, 0.0, 0.4});
    KeptSamples kept;
    std::atomic<std::int64_t> beats{0};
    device::PacedClock clock(device::PacedClock::default_spin(device::SchedulingPolicy::other));
    // An hour, unless something ends it.
    device::RunningServo running(thread, control, [&] {
      report = device::run_servo(device, force, kept, {.limit_ticks = 3'600'000}, clock,
                                 {.control = &control, .heartbeat = &beats});
    });
    while (beats.load() < 200 && running.is_running(std::chrono::milliseconds(1))) {
    }
    throw std::runtime_error("the window is gone");
  };
  CHECK_THROWS_WITH(attend(), "the window is gone");
  CHECK_FALSE(thread.running());
  CHECK(report.fault == device::SafetyFault::emergency_stop);
  REQUIRE_FALSE(device.written.empty());
  CHECK(device.written.back() == Vec3{});
  CHECK(device.written[device.written.size() - 2].z > 0.0);
}

TEST_CASE("a servo that ran to its end throws its exception once, and requests no stop") {
  device::ServoThread thread(kOrdinary);
  device::ServoControl control;
  {
    device::RunningServo running(thread, control, [] { throw std::runtime_error("no field"); });
    while (running.is_running(std::chrono::milliseconds(1))) {
    }
    CHECK_THROWS_WITH(running.finish(), "no field");
  }
  CHECK_FALSE(control.emergency_stop_requested());
}

TEST_CASE("requests are forgotten before a run, but stops hold until they are reset") {
  device::ServoControl control;
  control.finish();
  control.comfort_stop();
  control.emergency_stop();
  control.stall();
  control.clear_requests();
  CHECK_FALSE(control.finish_requested());
  CHECK_FALSE(control.comfort_stop_requested());
  CHECK(control.emergency_stop_requested());
  CHECK(control.stall_requested());
  control.reset();
  CHECK_FALSE(control.emergency_stop_requested());
  CHECK_FALSE(control.stall_requested());
}

}  // namespace

}  // namespace touchtrial
