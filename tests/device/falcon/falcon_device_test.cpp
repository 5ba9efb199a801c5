// The driver over the emulated Falcon without USB: one exchange for each tick, in virtual time.
#include "device/falcon/falcon_device.hpp"

#include "core/errors.hpp"
#include "device/falcon/falcon_inverse.hpp"
#include "device/falcon/rig/falcon_rig.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <cmath>

namespace touchtrial::device::falcon {
namespace {

constexpr std::array<std::int16_t, 3> kNoMotors{};
constexpr unsigned kRed = 1, kBlue = 4;

FalconOptions in_lockstep(Lockstep& lockstep) {
  FalconOptions options;
  options.pace = lockstep.pace();
  options.scheduling.policy = device::SchedulingPolicy::other;
  options.scheduling.lock_memory = false;
  return options;
}

/// A Falcon whose firmware runs, and its driver.
struct Rig {
  explicit Rig(bool homed, const device::FalconSettings& settings = {})
      : emulator({.firmware_runs = true, .homed = homed}),
        device(std::make_unique<FalconDevice>(std::make_unique<EmulatorTransport>(emulator),
                                              settings, in_lockstep(lockstep))) {}

  device::DeviceSample sample() {
    device::DeviceSample newest;
    status = device->read(newest);
    return newest;
  }
  /// Runs a tick in which the servo writes this force.
  void push(Vec3 force_n) {
    status = device->write(force_n);
    lockstep.step();
  }

  FalconEmulator emulator;
  Lockstep lockstep;
  std::unique_ptr<FalconDevice> device;
  device::DeviceStatus status = device::DeviceStatus::ok;
};

/// Carries the grip to and fro along the device's axis.
HandModel swinging_hand() {
  return [tick = 0](Vec3) mutable {
    return Vec3{0.0, 0.0, 25.0 * std::sin(2e-3 * std::acos(-1.0) * ++tick)};
  };
}

double error_n(Vec3 a, Vec3 b) {
  return norm(a - b);
}

TEST_CASE("a Falcon that is not homed is not ready, shows red and gets no force") {
  Rig rig(false);
  for (int i = 0; i < 20; ++i) rig.push({0.0, 0.0, 2.0});
  CHECK(rig.device->readiness() == device::DeviceReadiness::needs_homing);
  CHECK_FALSE(rig.sample().ready);
  CHECK(rig.sample().sequence == 20);
  CHECK(rig.emulator.motors() == kNoMotors);
  CHECK(rig.emulator.leds() == kRed);
}

TEST_CASE("a Falcon that is moved through its range homes, shows blue, and its forces pass") {
  Rig rig(false);
  rig.emulator.set_hand(swinging_hand());
  for (int i = 0; i < 1000; ++i) {
    rig.push({0.0, 0.0, 1.0});
    if (rig.emulator.all_homed()) break;
    REQUIRE(rig.emulator.motors() == kNoMotors);
  }
  REQUIRE(rig.emulator.all_homed());
  for (int i = 0; i < 3; ++i) rig.push({0.0, 0.0, 1.0});
  CHECK(rig.device->readiness() == device::DeviceReadiness::ready);
  CHECK(rig.sample().ready);
  CHECK(rig.emulator.leds() == kBlue);
  CHECK(error_n(rig.emulator.force_n(), {0.0, 0.0, 1.0}) < 0.01);
  CHECK(rig.emulator.complaints().empty());
}

TEST_CASE("the jump of the origin on homing is not a motion of the hand") {
  Rig rig(false);
  rig.emulator.set_hand(swinging_hand());
  double fastest_mm_s = 0.0;
  int ready = 0;
  for (int i = 0; i < 1000; ++i) {
    rig.push({});
    const device::DeviceSample sample = rig.sample();
    if (!sample.ready) continue;
    ++ready;
    fastest_mm_s = std::max(fastest_mm_s, norm(sample.velocity_mm_s));
  }
  REQUIRE(ready > 100);
  // 25 mm once a second are 157 mm/s.
  CHECK(fastest_mm_s < 200.0);
}

TEST_CASE("the lights follow the settings") {
  device::FalconSettings settings;
  settings.led_order = {2, 1, 0};
  Rig rig(true, settings);
  rig.lockstep.steps(3);
  CHECK(rig.emulator.leds() == 1);
}

TEST_CASE("the force at the hand is the written one, everywhere") {
  Rig rig(true);
  const Vec3 place_mm = GENERATE(Vec3{}, Vec3{20.0, 0.0, 0.0}, Vec3{-15.0, 20.0, 10.0},
                                 Vec3{10.0, -20.0, -25.0}, Vec3{0.0, 0.0, 30.0});
  const Vec3 force_n = GENERATE(Vec3{1.0, 0.0, 0.0}, Vec3{0.0, -2.0, 0.0}, Vec3{0.3, 0.4, 3.0});
  // Carried there no faster than a hand moves.
  rig.emulator.set_hand(
      [place_mm, tick = 0](Vec3) mutable { return std::min(1.0, ++tick / 100.0) * place_mm; });
  rig.lockstep.steps(110);
  rig.push(force_n);
  CHECK(error_n(rig.sample().position_mm, place_mm) < 0.06);
  CHECK(error_n(rig.emulator.force_n(), force_n) < 0.01 * norm(force_n));
}

TEST_CASE("a force beyond the motors keeps its direction") {
  Rig rig(true);
  rig.lockstep.steps(2);
  const Vec3 force_n = {600.0, 0.0, 800.0};
  rig.push(force_n);
  const Vec3 felt_n = rig.emulator.force_n();
  CHECK(norm(felt_n) < 900.0);
  CHECK(norm(felt_n) > 10.0);
  CHECK(error_n((1.0 / norm(felt_n)) * felt_n, {0.6, 0.0, 0.8}) < 0.01);
}

TEST_CASE("a force that is not finite is sent as zero") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.push({std::nan(""), 0.0, 1.0});
  CHECK(rig.emulator.motors() == kNoMotors);
}

TEST_CASE("the gravity bias acts while a servo runs, and only then") {
  device::FalconSettings settings;
  settings.gravity_bias_n = {0.0, 0.5, 0.0};
  Rig rig(true, settings);
  rig.lockstep.steps(3);
  CHECK(rig.emulator.motors() == kNoMotors);
  for (int i = 0; i < 600; ++i) rig.push({0.0, 0.0, 1.0});
  CHECK(error_n(rig.emulator.force_n(), {0.0, 0.5, 1.0}) < 0.01);
  rig.lockstep.steps(15);
  CHECK(rig.emulator.motors() == kNoMotors);
}

TEST_CASE("the gravity bias rises slowly, each time that a servo begins") {
  device::FalconSettings settings;
  settings.gravity_bias_n = {0.0, 1.0, 0.0};
  Rig rig(true, settings);
  rig.lockstep.steps(3);
  for (int round = 0; round < 2; ++round) {
    double before_n = 0.0;
    for (int i = 0; i < 600; ++i) {
      rig.push({});
      const double bias_n = rig.emulator.force_n().y;
      // 2 mN a millisecond, and the rounding of motor values.
      REQUIRE(std::abs(bias_n - before_n) < 0.012);
      before_n = bias_n;
    }
    CHECK(before_n == Approx(1.0).margin(0.01));
    rig.device->halt();
    rig.push({});
    CHECK(rig.emulator.motors() == kNoMotors);
    rig.device->rearm();
  }
}

TEST_CASE("a halted Falcon gets no force, bias or other, until it is re-armed") {
  device::FalconSettings settings;
  settings.gravity_bias_n = {0.0, 0.5, 0.0};
  Rig rig(true, settings);
  rig.lockstep.steps(2);
  rig.push({0.0, 0.0, 1.0});
  CHECK(rig.emulator.motors() != kNoMotors);
  rig.device->halt();
  rig.push({0.0, 0.0, 1.0});
  CHECK(rig.emulator.motors() == kNoMotors);
  rig.device->rearm();
  rig.push({0.0, 0.0, 1.0});
  CHECK(rig.emulator.motors() != kNoMotors);
}

TEST_CASE("the velocity is that of the hand") {
  Rig rig(true);
  rig.emulator.set_hand([tick = 0](Vec3) mutable { return Vec3{0.1 * ++tick - 10.0, 0.0, 0.0}; });
  // From the grip's place to where this hand begins, in jumps that the driver accepts at last.
  rig.lockstep.steps(50);
  const device::DeviceSample sample = rig.sample();
  CHECK(sample.velocity_mm_s.x == Approx(100.0).margin(12.0));
  CHECK(std::abs(sample.velocity_mm_s.y) < 12.0);
}

TEST_CASE("buttons are reported bit by bit") {
  Rig rig(true);
  for (const std::uint32_t button : {kButtonPlus, kButtonForward, kButtonCentre, kButtonMinus}) {
    rig.emulator.press(button);
    rig.lockstep.step();
    CHECK(rig.sample().buttons == button);
  }
}

TEST_CASE("a few lost replies only leave out samples") {
  Rig rig(true);
  rig.lockstep.steps(10);
  rig.emulator.drop_replies(2);
  rig.lockstep.steps(2);
  CHECK(rig.sample().sequence == 10);
  rig.lockstep.steps(3);
  CHECK(rig.sample().sequence == 13);
  CHECK(rig.status == device::DeviceStatus::ok);
}

TEST_CASE("without replies no force is sent, as the hand's position is unknown") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.emulator.drop_replies(10);
  for (int i = 0; i < FalconExchange::kForcelessAfter + 1; ++i) {
    rig.push({0.0, 0.0, 1.0});
    CHECK(rig.emulator.motors() != kNoMotors);
  }
  rig.push({0.0, 0.0, 1.0});
  CHECK(rig.emulator.motors() == kNoMotors);
  CHECK(rig.status == device::DeviceStatus::ok);
}

TEST_CASE("a Falcon that falls silent is a lost link") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.emulator.drop_replies(1'000'000);
  rig.lockstep.steps(FalconExchange::kLostAfter);
  CHECK(rig.device->fault() == device::DeviceFault::link_lost);
  CHECK(rig.device->write({}) == device::DeviceStatus::fault);
  rig.sample();
  CHECK(rig.status == device::DeviceStatus::fault);
  CHECK(rig.emulator.motors() == kNoMotors);
}

TEST_CASE("a Falcon whose answers make no sense is bad data") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.emulator.shorten_replies(1'000'000, 9);
  rig.lockstep.steps(FalconExchange::kLostAfter);
  CHECK(rig.device->fault() == device::DeviceFault::bad_data);
}

TEST_CASE("a little garbage between replies does no harm") {
  Rig rig(true);
  rig.lockstep.steps(2);
  for (std::uint8_t i = 0; i < 100; ++i) {
    rig.emulator.send_garbage(std::vector<std::uint8_t>{'<', 0x41, i, '>'});
    rig.lockstep.step();
  }
  CHECK(rig.status == device::DeviceStatus::ok);
  CHECK(rig.sample().sequence == 102);
  CHECK(norm(rig.sample().position_mm) < 0.06);
}

TEST_CASE("one impossible reading is left out, several in a row are accepted") {
  Rig rig(true);
  rig.lockstep.steps(5);
  rig.emulator.set_hand([tick = 0](Vec3) mutable {
    return ++tick == 1 || tick > 5 ? Vec3{25.0, 0.0, 0.0} : Vec3{};
  });
  rig.lockstep.step();
  CHECK(norm(rig.sample().position_mm) < 0.06);
  rig.lockstep.steps(4);
  CHECK(norm(rig.sample().position_mm) < 0.06);
  rig.lockstep.steps(FalconExchange::kMostJumps);
  CHECK(norm(rig.sample().position_mm) < 0.06);
  rig.lockstep.steps(2);
  CHECK(rig.sample().position_mm.x == Approx(25.0).margin(0.06));
}

TEST_CASE("a Falcon that loses its homing gets no force") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.emulator.forget_homing();
  for (int i = 0; i < 3; ++i) rig.push({0.0, 0.0, 1.0});
  CHECK(rig.device->readiness() == device::DeviceReadiness::needs_homing);
  CHECK_FALSE(rig.sample().ready);
  CHECK(rig.emulator.motors() == kNoMotors);
}

TEST_CASE("unplugging is a lost link, and the driver still closes without an error") {
  Rig rig(true);
  rig.push({0.0, 0.0, 1.0});
  rig.emulator.unplug();
  rig.lockstep.steps(2);
  CHECK(rig.device->fault() == device::DeviceFault::link_lost);
  rig.device.reset();
  CHECK(rig.emulator.motors() == kNoMotors);
}

TEST_CASE("closing sends packets without force and switches the lights off") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.push({0.0, 0.0, 1.0});
  REQUIRE(rig.emulator.motors() != kNoMotors);
  const std::uint64_t before = rig.emulator.exchanges();
  rig.device.reset();
  CHECK(rig.emulator.motors() == kNoMotors);
  CHECK(rig.emulator.leds() == 0);
  CHECK(rig.emulator.exchanges() >= before + FalconDevice::kFarewells);
  CHECK(rig.emulator.complaints().empty());
}

TEST_CASE("a Falcon without firmware is loaded from the user's file when it is opened") {
  const TempFolder folder;
  FalconEmulator emulator;
  Lockstep lockstep;
  device::FalconSettings settings;
  settings.firmware = write_dummy_firmware(folder.path());
  const FalconDevice device(std::make_unique<EmulatorTransport>(emulator), settings,
                            in_lockstep(lockstep));
  CHECK(emulator.image() == dummy_firmware());
  CHECK(device.readiness() == device::DeviceReadiness::needs_homing);
}

TEST_CASE("a Falcon without firmware and without a file names the setting") {
  FalconEmulator emulator;
  CHECK_THROWS_WITH(FalconDevice(std::make_unique<EmulatorTransport>(emulator), {}),
                    holds_text("set falcon.firmware"));
}

TEST_CASE("a firmware that does not run is reported") {
  const TempFolder folder;
  FalconEmulator emulator({.boot_loader = {.image = {1, 2, 3}}});
  device::FalconSettings settings;
  settings.firmware = write_dummy_firmware(folder.path());
  CHECK_THROWS_WITH(FalconDevice(std::make_unique<EmulatorTransport>(emulator), settings),
                    holds_text("may not be a Falcon's firmware"));
}

TEST_CASE("a Falcon describes itself") {
  Rig rig(true);
  const device::DeviceInfo info = rig.device->info();
  CHECK(info.name == "falcon");
  CHECK(info.serial == "EMULATED");
  CHECK(info.max_force_n == 8.0);
  CHECK_FALSE(info.simulated);
  REQUIRE(info.workspace);
  REQUIRE(info.workspace->shape == device::WorkspaceShape::ellipsoid);
  CHECK(info.workspace->least_mm == Vec3{-40.0, -40.0, -40.0});
  // Every place on the ball is in reach.
  for (double turn = 0.0; turn < 6.3; turn += 0.1) {
    for (double rise = -1.5; rise < 1.6; rise += 0.1) {
      const Vec3 place_mm{40.0 * std::cos(rise) * std::cos(turn), 40.0 * std::sin(rise),
                          40.0 * std::cos(rise) * std::sin(turn)};
      CHECK(inverse_kinematics(to_native_m(place_mm)).has_value());
    }
  }
}

}  // namespace
}  // namespace touchtrial::device::falcon
