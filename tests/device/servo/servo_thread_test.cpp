#include "device/servo/servo_thread.hpp"

#include "device/flat_wall.hpp"
#include "device/servo/paced_clock.hpp"
#include "device/servo/servo_fakes.hpp"
#include "support/catch.hpp"

#include <atomic>
#include <future>
#include <stdexcept>
#include <thread>

namespace touchtrial {
namespace {

/// Asks for nothing that changes the rest of the tests' process.
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

TEST_CASE("a servo thread works while others go on, and says when it is done") {
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

TEST_CASE("what work on a servo thread throws is thrown by wait, and the thread serves on") {
  device::ServoThread servo(kOrdinary);
  CHECK_THROWS_AS(servo.run([] { throw std::runtime_error("no field"); }), std::runtime_error);
  bool ran = false;
  servo.run([&] { ran = true; });
  CHECK(ran);
}

TEST_CASE("a servo thread that is let go of ends its work first") {
  std::atomic<bool> ended{false};
  {
    device::ServoThread servo(kOrdinary);
    servo.start([&] { ended = true; });
  }
  CHECK(ended);
}

TEST_CASE("an ordinary thread gets what it asked for, without a reason") {
  const device::ServoThread servo(kOrdinary);
  CHECK(servo.scheduling().policy == device::SchedulingPolicy::other);
  CHECK(servo.scheduling().priority == 0);
  CHECK_FALSE(servo.scheduling().memory_locked);
  CHECK(servo.scheduling().reason.empty());
}

TEST_CASE("a thread that asks for real time gets it, or the reason and remedy on one line") {
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
  device::PacedClock clock(device::PacedClock::usual_spin(servo.scheduling().policy));
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

}  // namespace
}  // namespace touchtrial
