// When ticks begin, how late they are, and which are left out, by a clock that is late by script.
#include "device/flat_wall.hpp"
#include "device/servo/duration_histogram.hpp"
#include "device/servo/servo.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr microseconds kOnTime{0};

struct PacedRun {
  device::ServoReport report;
  std::vector<std::int64_t> ticks;
};

PacedRun run(LateClock clock, device::ServoOptions options, const device::ServoHooks& hooks = {}) {
  ScriptedDevice device;
  ConstantForce force({0.0, 0.0, 0.5});
  KeptSamples kept;
  options.limits = norm_limit_alone();
  PacedRun run{device::run_servo(device, force, kept, options, clock, hooks), {}};
  for (const device::ServoSample& sample : kept.samples) run.ticks.push_back(sample.tick);
  return run;
}

TEST_CASE("ticks on time have no lateness and the requested rate") {
  const double rate_hz = GENERATE(1000.0, 3000.0, 4000.0, 10'000.0);
  const PacedRun done =
      run(LateClock({}), {.limit_ticks = 500, .fade_ticks = 0, .rate_hz = rate_hz});
  CHECK(done.ticks.size() == 500);
  CHECK(done.report.overruns == 0);
  CHECK(done.report.lateness.worst_us == 0.0);
  CHECK(done.report.rate_hz == Approx(rate_hz).epsilon(1e-5));
}

TEST_CASE("a tick that is late by less than a period runs, and the next one is on time again") {
  const PacedRun done =
      run(LateClock({kOnTime, microseconds(700), kOnTime}), {.limit_ticks = 4, .fade_ticks = 0});
  CHECK(done.ticks == std::vector<std::int64_t>{0, 1, 2, 3});
  CHECK(done.report.overruns == 0);
  CHECK(done.report.lateness.worst_us == 700.0);
  CHECK(done.report.lateness.p50_us == 0.0);
  CHECK(done.report.rate_hz == Approx(1000.0));
}

TEST_CASE("missed ticks are left out, never made up for in a burst") {
  const PacedRun done =
      run(LateClock({kOnTime, kOnTime, microseconds(4300)}), {.limit_ticks = 10, .fade_ticks = 0});
  CHECK(done.ticks == std::vector<std::int64_t>{0, 1, 6, 7, 8, 9});
  CHECK(done.report.ticks == 6);
  CHECK(done.report.overruns == 4);
  CHECK(done.report.lateness.worst_us == 4300.0);
  CHECK(done.report.rate_hz == Approx(5.0 / 9.0 * 1000.0).epsilon(0.02));
}

TEST_CASE("a tick that begins just as the next one is due is left out for that one") {
  const PacedRun done =
      run(LateClock({kOnTime, milliseconds(1)}), {.limit_ticks = 4, .fade_ticks = 0});
  CHECK(done.ticks == std::vector<std::int64_t>{0, 2, 3});
  CHECK(done.report.overruns == 1);
}

TEST_CASE("a loop that stood still until time was up sends only the final zero") {
  ScriptedDevice device;
  ConstantForce force({0.0, 0.0, 0.5});
  KeptSamples kept;
  LateClock clock({kOnTime, std::chrono::seconds(2)});
  const device::ServoOptions options{
      .limit_ticks = 1000, .fade_ticks = 100, .limits = norm_limit_alone()};
  const device::ServoReport report = device::run_servo(device, force, kept, options, clock);
  CHECK(report.end == device::ServoEnd::time_limit);
  CHECK(report.ticks == 1);
  CHECK(report.overruns == 1099);
  CHECK(device.written == std::vector<Vec3>{{0.0, 0.0, 0.5}, {}});
}

TEST_CASE("lateness counts from the tick that was due first") {
  device::DurationHistogram lateness;
  device::ServoHooks hooks{.lateness = &lateness};
  const device::ServoOptions options{.limit_ticks = 10, .fade_ticks = 0};
  static_cast<void>(run(LateClock({kOnTime, milliseconds(4)}), options, hooks));
  CHECK(lateness.worst() == milliseconds(4));
  CHECK(lateness.count() == 6);
  SECTION("and adds up over runs") {
    static_cast<void>(run(LateClock({milliseconds(1)}), options, hooks));
    CHECK(lateness.worst() == milliseconds(4));
    CHECK(lateness.count() == 6 + 9);
  }
}

TEST_CASE("a watcher sees how late the newest tick was") {
  device::LatestValue<device::ServoState> state;
  device::ServoHooks hooks{.state = &state};
  static_cast<void>(run(LateClock({kOnTime, kOnTime, microseconds(250)}),
                        {.limit_ticks = 3, .fade_ticks = 0}, hooks));
  CHECK(state.get().tick == 2);
  CHECK(state.get().lateness_us == 250.0);
}

TEST_CASE("virtual time is never late and has the options' rate") {
  ScriptedDevice device;
  ConstantForce force({});
  KeptSamples kept;
  const device::ServoReport report =
      device::run_servo_in_virtual_time(device, force, kept, {.limit_ticks = 3, .rate_hz = 4000.0});
  CHECK(report.rate_hz == 4000.0);
  CHECK(report.lateness.worst_us == 0.0);
}

TEST_CASE("a rate or a number of ticks out of range is refused before the first tick") {
  ScriptedDevice device;
  ConstantForce force({});
  KeptSamples kept;
  const device::ServoOptions options =
      GENERATE(device::ServoOptions{.rate_hz = 999.0}, device::ServoOptions{.rate_hz = 10'001.0},
               device::ServoOptions{.rate_hz = std::numeric_limits<double>::quiet_NaN()},
               device::ServoOptions{.limit_ticks = -1}, device::ServoOptions{.fade_ticks = -1});
  CHECK_THROWS_AS(device::run_servo_in_virtual_time(device, force, kept, options),
                  std::invalid_argument);
  CHECK(device.reads == 0);
}

TEST_CASE("finishing before a fade of no length ends the run without a fault") {
  ScriptedDevice device;
  ConstantForce force({0.0, 0.0, 0.5});
  KeptSamples kept;
  device::ServoControl control;
  control.finish();
  device::ServoHooks hooks{.control = &control};
  device::VirtualClock clock;
  const device::ServoReport report =
      device::run_servo(device, force, kept, {.fade_ticks = 0}, clock, hooks);
  CHECK(report.end == device::ServoEnd::hand_stopped);
  CHECK(device.written == std::vector<Vec3>{{}});
}

}  // namespace
}  // namespace touchtrial
