#include "device/servo/running_servo.hpp"

#include "device/flat_wall.hpp"
#include "device/servo/paced_clock.hpp"
#include "device/servo/servo_fakes.hpp"
#include "support/catch.hpp"

#include <atomic>
#include <stdexcept>

namespace touchtrial {
namespace {

constexpr device::SchedulingRequest kOrdinary{device::SchedulingPolicy::other, 0, false};

TEST_CASE("whoever attends to a running servo and fails leaves the hand without force") {
  device::ServoThread thread(kOrdinary);
  device::ServoControl control;
  ScriptedDevice device;
  device::ServoReport report;
  const auto attend = [&] {
    ConstantForce force({0.0, 0.0, 0.4});
    KeptSamples kept;
    std::atomic<std::int64_t> beats{0};
    device::PacedClock clock(device::PacedClock::usual_spin(device::SchedulingPolicy::other));
    // An hour, if nobody ended it.
    device::RunningServo running(thread, control, [&] {
      report = device::run_servo(device, force, kept, {.limit_ticks = 3'600'000}, clock,
                                 {.control = &control, .heartbeat = &beats});
    });
    while (beats.load() < 200 && running.runs(std::chrono::milliseconds(1))) {
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

TEST_CASE("a servo that ran to its end throws what it threw, once, and asks for no stop") {
  device::ServoThread thread(kOrdinary);
  device::ServoControl control;
  {
    device::RunningServo running(thread, control, [] { throw std::runtime_error("no field"); });
    while (running.runs(std::chrono::milliseconds(1))) {
    }
    CHECK_THROWS_WITH(running.finish(), "no field");
  }
  CHECK_FALSE(control.emergency_stop_asked());
}

TEST_CASE("wishes are forgotten before a run, but stops hold until they are taken back") {
  device::ServoControl control;
  control.finish();
  control.comfort_stop();
  control.emergency_stop();
  control.stall();
  control.forget_wishes();
  CHECK_FALSE(control.finish_asked());
  CHECK_FALSE(control.comfort_stop_asked());
  CHECK(control.emergency_stop_asked());
  CHECK(control.stall_seen());
  control.reset();
  CHECK_FALSE(control.emergency_stop_asked());
  CHECK_FALSE(control.stall_seen());
}

}  // namespace
}  // namespace touchtrial
