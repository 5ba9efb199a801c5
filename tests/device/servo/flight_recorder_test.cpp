#include "device/servo/flight_recorder.hpp"

#include "device/flat_wall.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

std::vector<device::FlightTick> fly(ScriptedDevice& device, Vec3 force_n,
                                    device::FlightRecorder& recorder,
                                    device::ServoOptions options = {.limit_ticks = 10,
                                                                    .fade_ticks = 0}) {
  ConstantForce force(force_n);
  KeptSamples kept;
  LateClock clock({microseconds(0), microseconds(20)});
  device::ServoHooks hooks{.recorder = &recorder};
  static_cast<void>(device::run_servo(device, force, kept, options, clock, hooks));
  return recorder.ticks();
}

TEST_CASE("a flight recorder holds the last seconds, oldest tick first") {
  ScriptedDevice device;
  device::FlightRecorder recorder(0.004, 1000.0);
  const std::vector<device::FlightTick> ticks = fly(device, {0.0, 0.0, 0.5}, recorder);
  REQUIRE(ticks.size() == 4);
  for (int i = 0; i < 4; ++i) {
    const device::FlightTick& tick = ticks[static_cast<std::size_t>(i)];
    CHECK(tick.tick == 6 + i);
    CHECK(tick.time == milliseconds(6 + i));
    CHECK(tick.sample.position_mm.x == 6.0 + i);
    CHECK(tick.sample.sequence == static_cast<std::uint64_t>(7 + i));
  }
}

TEST_CASE("a flight recorder shows the requested force beside the sent one") {
  ScriptedDevice device;
  device::FlightRecorder recorder(1.0, 1000.0);
  const std::vector<device::FlightTick> ticks = fly(device, {0.0, 0.0, 5.0}, recorder);
  REQUIRE(ticks.size() == 10);
  CHECK(ticks[1].requested_n == Vec3{0.0, 0.0, 5.0});
  CHECK(ticks[1].sent_n == device.written[1]);
  CHECK(ticks[1].verdict == device::SafetyVerdict::limited);
  CHECK(ticks[1].lateness_us == 20.0);
  CHECK(ticks[1].time == microseconds(1020));
}

TEST_CASE("the tick of a fault is the last one in a flight recorder") {
  ScriptedDevice device;
  device::FlightRecorder recorder(1.0, 1000.0);
  SECTION("of the device while reading") {
    device.ticks = 3;
    device.end = device::DeviceStatus::fault;
    device.device_fault = device::DeviceFault::link_lost;
    const device::FlightTick last = fly(device, {0.0, 0.0, 0.5}, recorder).back();
    CHECK(last.tick == 3);
    CHECK(last.fault == device::SafetyFault::device);
    CHECK(last.device_fault == device::DeviceFault::link_lost);
  }
  SECTION("of the device while writing") {
    device.fails_at_write = 3;
    const device::FlightTick last = fly(device, {0.0, 0.0, 0.5}, recorder).back();
    CHECK(last.tick == 2);
    CHECK(last.verdict == device::SafetyVerdict::fault);
    CHECK(last.sent_n == Vec3{});
  }
  SECTION("of the force") {
    const Vec3 nothing{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0};
    const device::FlightTick last = fly(device, nothing, recorder).back();
    CHECK(last.tick == 0);
    CHECK(last.fault == device::SafetyFault::not_finite);
    CHECK(last.device_fault == device::DeviceFault::none);
  }
}

TEST_CASE("a cleared flight recorder holds nothing of the previous trial") {
  ScriptedDevice device;
  device::FlightRecorder recorder(1.0, 1000.0);
  REQUIRE_FALSE(fly(device, {}, recorder).empty());
  recorder.clear();
  CHECK(recorder.ticks().empty());
}

TEST_CASE("a flight recorder of no length, or of more than it could hold, is refused") {
  CHECK_THROWS_AS(device::FlightRecorder(0.0, 1000.0), std::invalid_argument);
  CHECK_THROWS_AS(device::FlightRecorder(1.0, -1.0), std::invalid_argument);
  CHECK_THROWS_AS(device::FlightRecorder(1e9, 1000.0), std::invalid_argument);
  CHECK_THROWS_AS(device::FlightRecorder(std::numeric_limits<double>::quiet_NaN(), 1.0),
                  std::invalid_argument);
}

TEST_CASE("a flight as CSV has a name for every column and one row per tick") {
  device::FlightTick tick{.tick = 12,
                          .time = microseconds(12'500),
                          .sample = {{0.1, -2.0, 3.5}, {1.0, 2.0, 3.0}, 77, 5, true},
                          .requested_n = {0.0, 0.25, 4.0},
                          .sent_n = {0.0, 0.2, 3.2},
                          .verdict = device::SafetyVerdict::fault,
                          .fault = device::SafetyFault::stale_sample,
                          .device_fault = device::DeviceFault::warm_motors,
                          .lateness_us = 1.25};
  const std::string text = device::flight_csv(std::vector{tick});
  const std::string header = text.substr(0, text.find("\r\n"));
  CHECK(header.starts_with("tick,time_s,x_mm,"));
  CHECK(text.substr(header.size()) ==
        "\r\n12,0.0125,0.1,-2,3.5,1,2,3,0,0.25,4,0,0.2,3.2,fault,stale_sample,warm_motors,1.25,77,"
        "5,1,,,"
        "\r\n");
  const std::string row = text.substr(header.size() + 2);
  CHECK(std::count(header.begin(), header.end(), ',') == std::count(row.begin(), row.end(), ','));
  tick.sample.delivered_n = {0.0, 0.1, 3.0};
  CHECK(device::flight_csv(std::vector{tick}).ends_with(",77,5,1,0,0.1,3\r\n"));
}

}  // namespace
}  // namespace touchtrial
