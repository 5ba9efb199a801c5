/// \file The fake libraries as a test uses them: fresh for each test, free or step by step.
#pragma once

#include "device/fakes/fake_dhd.hpp"
#include "device/fakes/fake_hd.hpp"
#include "device/flat_wall.hpp"
#include "device/haptic_device.hpp"
#include "device/platform/dynamic_library.hpp"
#include "device/servo/placed_device.hpp"
#include "device/servo/servo_clock.hpp"
#include "support/catch.hpp"

#include <chrono>
#include <string>
#include <thread>

namespace touchtrial::fakes {

/// Polls until a condition holds.
/// \return false if it does not within five minutes, so that something hangs
template <typename Predicate>
[[nodiscard]] bool eventually(Predicate holds) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// \return a sample that the driver read entirely after this call
[[nodiscard]] inline device::DeviceSample next_sample(device::HapticDevice& device) {
  device::DeviceSample before;
  device::DeviceSample after;
  (void)device.read(before);
  REQUIRE(eventually([&] {
    (void)device.read(after);
    return after.sequence > before.sequence + 1;
  }));
  return after;
}

/// Writes as a servo does until a condition of the fake holds.
/// \return false if it does not within five minutes
template <typename Predicate>
[[nodiscard]] bool write_until(device::HapticDevice& device, Vec3 force_n, Predicate holds) {
  return eventually([&] {
    (void)device.write(force_n);
    return holds();
  });
}

/// The library that a driver under test loads too: both see the same state.
template <typename Exports>
class LoadedFake {
 public:
  LoadedFake(const char* file, const char* entry)
      : library_(file, device::Unload::never, "build the tests"),
        exports_(*library_.function<Exports*()>(entry)()) {
    exports_.reset();
    exports_.run_freely();
  }

  [[nodiscard]] auto* operator->() const noexcept { return exports_.state; }
  [[nodiscard]] const Exports& exports() const noexcept { return exports_; }
  [[nodiscard]] std::string calls() const { return exports_.calls(); }

 private:
  device::DynamicLibrary library_;
  Exports& exports_;
};

/// The fake's steps as the servo's time: a tick of the servo is one of the fake, and no other clock
/// matters. While this lives, the fake moves in these steps alone.
template <typename Exports>
class SteppingClock final : public device::ServoClock {
 public:
  explicit SteppingClock(const Exports& fake) : fake_(fake) { REQUIRE(fake_.step(1)); }
  ~SteppingClock() override { fake_.run_freely(); }
  SteppingClock(const SteppingClock&) = delete;
  SteppingClock& operator=(const SteppingClock&) = delete;

  [[nodiscard]] Time now() noexcept override { return now_; }
  void wait_until(Time time) noexcept override {
    while (now_ < time) {
      now_ += std::chrono::milliseconds(1);
      hung_ = hung_ || !fake_.step(1);
    }
  }
  [[nodiscard]] bool hung() const noexcept { return hung_; }

 private:
  const Exports& fake_;
  Time now_{};
  bool hung_ = false;
};

/// A servo that presses a fake's hand on a flat wall.
template <typename Exports>
class WallRun {
 public:
  /// \param device,fake  must outlive this
  WallRun(device::HapticDevice& device, const Exports& fake) : placed_(device, {}), clock_(fake) {}

  [[nodiscard]] device::ServoReport run(std::int64_t ticks) {
    return device::run_servo(placed_, wall_, kept_, {.limit_ticks = ticks}, clock_);
  }

  /// Runs for a second and checks that the hand, pushed by 0.7 N, settles where the wall carries
  /// it, or deeper: a stall of the machine lets forces lapse, see DeviceLink::kForceLifetime.
  void check_carries_hand() {
    CHECK(run(1000).end == device::ServoEnd::time_limit);
    CHECK_FALSE(clock_.hung());
    REQUIRE(kept_.samples.size() > 999);
    const device::ServoSample& settled = kept_.samples[999];
    CHECK(settled.position_mm.z < -1.5);
    CHECK(settled.position_mm.z > -4.0);
    CHECK(settled.force_n.z == Approx(-0.4 * settled.position_mm.z).margin(1e-9));
  }

 private:
  device::PlacedDevice placed_;
  FlatWall wall_;
  KeptSamples kept_;
  SteppingClock<Exports> clock_;
};

struct LoadedDhd : LoadedFake<FakeDhdExports> {
  LoadedDhd() : LoadedFake(TOUCHTRIAL_FAKE_DHD, "fake_dhd_exports") {}
};

/// libdrd, which has the functions of libdhd too.
struct LoadedDrd : LoadedFake<FakeDhdExports> {
  LoadedDrd() : LoadedFake(TOUCHTRIAL_FAKE_DRD, "fake_dhd_exports") {}
};

struct LoadedHd : LoadedFake<FakeHdExports> {
  LoadedHd() : LoadedFake(TOUCHTRIAL_FAKE_HD, "fake_hd_exports") {}
};

}  // namespace touchtrial::fakes
