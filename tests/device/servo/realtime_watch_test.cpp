// Nothing in the servo's loop takes memory or a lock, and the watch that proves it detects code
// that does.
#include "support/realtime_watch.hpp"

#include "device/drivers/device_link.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/flat_wall.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/duration_histogram.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/placed_device.hpp"
#include "device/servo/sample_ring.hpp"
#include "device/servo/servo_clock.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <cstdlib>
#include <functional>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <thread>

namespace touchtrial {
namespace {

device::SimulatedHand stroking_hand() {
  RandomStream random(1, "realtime watch");
  return device::SimulatedHand({},
                               device::ExplorationPath(PlaneGeometry{0.2, 200, 200}, {}, random));
}

/// A wall that also calls a function.
ForceBy busy_wall(std::function<void()> work) {
  return ForceBy([work = std::move(work)](const device::DeviceSample& sample) {
    work();
    return FlatWall().force_n(sample);
  });
}

RealtimeOffences offences_of(device::HapticDevice& device, device::ForceSource& force,
                             device::ServoClock& clock, std::int64_t ticks) {
  device::SampleRing ring(20'000);
  device::RingSink sink(ring);
  device::ServoControl control;
  device::LatestValue<device::ServoState> state;
  std::atomic<std::int64_t> heartbeat{0};
  device::FlightRecorder recorder(0.5, device::kServoRateHz);
  device::DurationHistogram lateness;
  const device::ServoHooks hooks{&control, &state, &heartbeat, &recorder, &lateness};
  static_cast<void>(take_realtime_offences());
  const device::ServoReport report =
      device::run_servo(device, force, sink, {.limit_ticks = ticks}, clock, hooks);
  const RealtimeOffences offences = take_realtime_offences();
  CHECK(report.ticks > 0);
  return offences;
}

TEST_CASE("the loop with every hook and a simulated hand takes no memory and no lock") {
  device::SimulatedHand hand = stroking_hand();
  FlatWall wall;
  SECTION("in virtual time") {
    device::VirtualClock clock;
    CHECK(offences_of(hand, wall, clock, 5000) == RealtimeOffences{});
  }
  SECTION("in real time") {
    device::PacedClock clock(std::chrono::microseconds(50));
    CHECK(offences_of(hand, wall, clock, 100) == RealtimeOffences{});
  }
  SECTION("placed in the frame of a device") {
    device::PlacedDevice placed(hand, {});
    device::VirtualClock clock;
    CHECK(offences_of(placed, wall, clock, 100) == RealtimeOffences{});
  }
}

TEST_CASE("a driver's link takes no memory and no lock") {
  device::DeviceLink link;
  device::DeviceSample sample;
  static_cast<void>(take_realtime_offences());
  {
    const device::RealtimeRegion region;
    link.publish({});
    static_cast<void>(link.read(sample));
    static_cast<void>(link.write({}, {}));
    static_cast<void>(link.force_to_send({}));
    link.fail(device::DeviceFault::link_lost);
  }
  CHECK(take_realtime_offences() == RealtimeOffences{});
}

TEST_CASE("a force source that takes memory in the loop is caught") {
  device::SimulatedHand hand = stroking_hand();
  device::VirtualClock clock;
  SECTION("by growing") {
    std::vector<std::string> grown;
    ForceBy wall = busy_wall([&] { grown.emplace_back(100, 'x'); });
    CHECK(offences_of(hand, wall, clock, 10).allocations >= 100);
  }
  SECTION("by malloc") {
    void* volatile block = nullptr;
    ForceBy wall = busy_wall([&] { block = block == nullptr ? std::malloc(10) : block; });
    CHECK(offences_of(hand, wall, clock, 10).allocations == 1);
    std::free(block);
  }
  SECTION("by giving it back") {
    void* volatile block = std::malloc(10);
    ForceBy wall = busy_wall([&] {
      std::free(block);
      block = nullptr;
    });
    CHECK(offences_of(hand, wall, clock, 10).frees == 1);
  }
}

TEST_CASE("a force source that locks in the loop is caught") {
  if (!locks_are_watched()) return;
  device::SimulatedHand hand = stroking_hand();
  device::VirtualClock clock;
  SECTION("a mutex") {
    std::mutex mutex;
    ForceBy wall = busy_wall([&] { const std::lock_guard lock(mutex); });
    CHECK(offences_of(hand, wall, clock, 10).locks >= 10);
  }
  SECTION("a shared mutex") {
    std::shared_mutex mutex;
    ForceBy wall = busy_wall([&] { const std::shared_lock lock(mutex); });
    CHECK(offences_of(hand, wall, clock, 10).locks >= 10);
  }
}

TEST_CASE("memory and locks outside the loop, and of several threads at once, are no offence") {
  static_cast<void>(take_realtime_offences());
  std::mutex mutex;
  const auto work = [&] {
    const std::lock_guard lock(mutex);
    CHECK(std::string(100, 'x').size() == 100);
  };
  {
    std::thread other(work);
    other.join();
  }
  work();
  CHECK(take_realtime_offences() == RealtimeOffences{});
}

}  // namespace
}  // namespace touchtrial
