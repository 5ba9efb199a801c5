// The driver over the emulated Falcon without USB: one exchange for each tick, in virtual time.
#include "device/drivers/falcon/falcon_device.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "device/drivers/falcon/emulator/falcon_legs.hpp"
#include "device/drivers/falcon/rig/falcon_rig.hpp"
#include "device/flat_wall.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <cmath>

namespace touchtrial::device::falcon {
namespace {

constexpr std::array<std::int16_t, 3> kNoMotors{};
constexpr Lamps kRed{.red = true};
constexpr Lamps kBlue{.blue = true};

FalconOptions in_lockstep(Lockstep& lockstep) {
  FalconOptions options{.pace = lockstep.pace()};
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

/// A run of the servo on such a device, an exchange for each tick.
device::ServoReport run_on(Rig& rig, device::ForceSource& force,
                           const device::ServoOptions& options) {
  LockstepDevice paced(*rig.device, rig.lockstep);
  NoSamples none;
  return device::run_servo_in_virtual_time(paced, force, none, options);
}

/// Carries the grip to and fro along the device's axis.
HandModel swinging_hand() {
  return [tick = 0](Vec3) mutable {
    return Vec3{0.0, 0.0, 25.0 * std::sin(2e-3 * std::acos(-1.0) * ++tick)};
  };
}

/// A hand that trembles.
HandModel trembling_hand() {
  return [tick = 0](Vec3) mutable { return Vec3{0.0, 0.0, ++tick % 2 == 0 ? 0.1 : -0.1}; };
}

double error_n(Vec3 a, Vec3 b) {
  return norm(a - b);
}

/// \return how far the newest sample is from where the grip is now, mm
double error_mm(Rig& rig) {
  return norm(rig.sample().position_mm - rig.emulator.position_mm());
}

TEST_CASE("a Falcon that is not homed is not ready, shows red and gets no force") {
  Rig rig(false);
  for (int i = 0; i < 20; ++i) rig.push({0.0, 0.0, 2.0});
  CHECK(rig.device->readiness() == device::DeviceReadiness::needs_homing);
  CHECK_FALSE(rig.sample().ready);
  CHECK(rig.sample().sequence == 20);
  CHECK(rig.emulator.motors() == kNoMotors);
  CHECK(rig.emulator.lamps() == kRed);
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
  CHECK(rig.emulator.lamps() == kBlue);
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
  device::FalconSettings settings{.led_order = {2, 1, 0}};
  Rig rig(true, settings);
  rig.lockstep.steps(3);
  CHECK(rig.emulator.lamps() == Lamps{.green = true});
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
  // What the legs give with one motor at 4,095.
  CHECK(norm(felt_n) > 6.51);
  CHECK(norm(felt_n) < 16.0);
  CHECK(rig.emulator.complaints().empty());
  rig.lockstep.step();
  CHECK(rig.sample().limited);
  rig.push({0.0, 0.0, 1.0});
  rig.push({0.0, 0.0, 1.0});
  CHECK_FALSE(rig.sample().limited);
  CHECK(error_n((1.0 / norm(felt_n)) * felt_n, {0.6, 0.0, 0.8}) < 0.01);
}

TEST_CASE("a force that is not finite is sent as zero") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.push({std::nan(""), 0.0, 1.0});
  CHECK(rig.emulator.motors() == kNoMotors);
}

TEST_CASE("the gravity bias is the Falcon's support, and the driver adds nothing to a force") {
  device::FalconSettings settings{.gravity_bias_n = {0.0, 0.5, 0.0}};
  Rig rig(true, settings);
  CHECK(rig.device->support_force_n(rig.sample()) == Vec3{0.0, 0.5, 0.0});
  for (int i = 0; i < 20; ++i) rig.push({0.0, 0.0, 1.0});
  CHECK(error_n(rig.emulator.force_n(), {0.0, 0.0, 1.0}) < 0.01);
  rig.push({});
  CHECK(rig.emulator.motors() == kNoMotors);
}

TEST_CASE("force and gravity bias each stay within their own limit on a Falcon") {
  device::FalconSettings settings{.gravity_bias_n = {0.0, 1.0, 0.0}};
  Rig rig(true, settings);
  ConstantForce force({0.0, 0.0, 0.4});
  Vec3 max_n;
  rig.emulator.set_hand([&](Vec3 force_n) {
    max_n = {max_n.x, std::max(max_n.y, force_n.y), std::max(max_n.z, force_n.z)};
    return Vec3{};
  });
  device::ServoOptions options{.limit_ticks = 300};
  options.limits.max_force_n = 0.3;
  const device::ServoReport report = run_on(rig, force, options);
  CHECK(report.end == device::ServoEnd::time_limit);
  CHECK(max_n.y == Approx(1.0).margin(0.01));
  CHECK(max_n.z == Approx(0.3).margin(0.01));
}

TEST_CASE(
    "a Falcon's motor that bears all is limited before the force is, and the servo counts it") {
  device::FalconSettings settings{.motor_continuous = 345, .motor_peak_s = 0.05};
  Rig rig(true, settings);
  // At the centre 1 N upwards takes about 500 of one motor.
  rig.emulator.set_hand(trembling_hand());
  ConstantForce force({0.0, 1.0, 0.0});
  device::ServoOptions options{.limit_ticks = 6'000};
  options.limits.engage_force_n = 2.0;
  const device::ServoReport report = run_on(rig, force, options);
  CHECK(report.end == device::ServoEnd::time_limit);
  CHECK(report.limited_ticks > 1'000);
  CHECK(report.limited_ticks < 5'900);
}

TEST_CASE("a Falcon whose encoders stop under a force ends the run, and its motors rest") {
  Rig rig(true);
  rig.emulator.set_hand(trembling_hand());
  ForceBy force([&rig, calls = 0](const device::DeviceSample&) mutable {
    if (++calls == 500) rig.emulator.stick_encoders(true);
    return Vec3{0.0, 0.0, 1.1};
  });
  device::ServoOptions options{.limit_ticks = 3'000};
  options.limits.engage_force_n = 2.0;
  const device::ServoReport report = run_on(rig, force, options);
  CHECK(report.fault == device::SafetyFault::frozen_encoders);
  CHECK(report.ticks > 790);
  CHECK(report.ticks < 810);
  rig.lockstep.step();
  CHECK(rig.emulator.motors() == kNoMotors);
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

/// Carries the grip 0.3 mm further each exchange: further than an encoder's step.
HandModel moving_hand() {
  return [tick = 0](Vec3) mutable { return Vec3{0.3 * tick++, 0.0, 0.0}; };
}

TEST_CASE("a late reply of a Falcon does not answer the next command") {
  Rig rig(true);
  rig.emulator.set_hand(moving_hand());
  rig.lockstep.steps(20);
  CHECK(error_mm(rig) < 0.1);
  const int late = GENERATE(1, 2, 3);
  for (int i = 0; i < late; ++i) {
    rig.emulator.delay_replies(1);
    rig.lockstep.steps(2);
    // Both replies came: the loop is back in step.
    REQUIRE(error_mm(rig) < 0.1);
  }
  for (int i = 0; i < 20; ++i) {
    rig.lockstep.step();
    REQUIRE(error_mm(rig) < 0.1);
  }
  CHECK(rig.sample().sequence == 40U + 2U * static_cast<unsigned>(late));
  CHECK(rig.device->fault() == device::DeviceFault::none);
}

TEST_CASE("late and lost replies in any order leave the loop of a Falcon in step") {
  Rig rig(true);
  rig.emulator.set_hand([tick = 0](Vec3) mutable {
    return Vec3{20.0 * std::sin(0.01 * ++tick), 0.0, 0.0};
  });
  RandomStream random(1, "late falcon");
  rig.lockstep.steps(20);
  for (int round = 0; round < 60; ++round) {
    rig.emulator.delay_replies(static_cast<int>(random.below(3)));
    rig.emulator.drop_replies(static_cast<int>(random.below(2)));
    // What is lost is given up after some exchanges; what is late has come by then.
    rig.lockstep.steps(3 + FalconExchange::kLostAfterOverdue);
    rig.emulator.delay_replies(0);
    rig.lockstep.steps(FalconExchange::kLostAfterOverdue);
    REQUIRE(rig.device->fault() == device::DeviceFault::none);
    for (int i = 0; i < 3; ++i) {
      rig.lockstep.step();
      REQUIRE(error_mm(rig) < 0.1);
    }
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
  for (int i = 0; i < FalconExchange::kForcelessAfter; ++i) {
    rig.push({0.0, 0.0, 1.0});
    CHECK(rig.emulator.motors() != kNoMotors);
  }
  rig.push({0.0, 0.0, 1.0});
  CHECK(rig.emulator.motors() == kNoMotors);
  CHECK(rig.status == device::DeviceStatus::ok);
}

TEST_CASE("a Falcon that falls silent is a lost link after 60 ms, and is sent no force") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.emulator.drop_replies(1'000'000);
  const auto began = rig.lockstep.now();
  rig.lockstep.steps(FalconExchange::kLostAfter - 1);
  CHECK(rig.device->fault() == device::DeviceFault::none);
  rig.lockstep.step();
  // The first of them begins a period after the last reply.
  CHECK(rig.lockstep.now() - began == FalconDevice::kPeriod + std::chrono::milliseconds(60));
  CHECK(rig.device->fault() == device::DeviceFault::link_lost);
  CHECK(rig.device->write({}) == device::DeviceStatus::fault);
  rig.sample();
  CHECK(rig.status == device::DeviceStatus::fault);
  CHECK(rig.emulator.motors() == kNoMotors);
}

/// The Falcon at the servo's pace, both in virtual time: an exchange whose reply is lost takes as
/// long as it does on the bus, while the servo ticks on.
class PacedFalcon final : public LockstepDevice {
 public:
  explicit PacedFalcon(Rig& rig) : LockstepDevice(*rig.device, rig.lockstep), rig_(rig) {}
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    time_ += std::chrono::milliseconds(1);
    if (time_ == lose_at) rig_.emulator.drop_replies(lost);
    while (rig_.lockstep.now() < time_) rig_.lockstep.step();
    return rig_.device->read(sample);
  }

  std::chrono::milliseconds lose_at{100};
  int lost = 0;

 private:
  Rig& rig_;
  FalconPace::Time time_{};
};

TEST_CASE("a run on a Falcon survives two lost replies in a row, and ends with the third") {
  const int lost = GENERATE(0, 1, 2, 3, 20);
  Rig rig(true);
  PacedFalcon paced(rig);
  paced.lost = lost;
  ConstantForce force({0.0, 0.0, 0.4});
  KeptSamples kept;
  device::ServoOptions options{.limit_ticks = 500};
  const device::ServoReport report = device::run_servo_in_virtual_time(paced, force, kept, options);
  INFO(lost << " lost");
  CHECK((report.end == device::ServoEnd::time_limit) == (lost <= 2));
  if (lost <= 2) return;
  CHECK(report.fault == device::SafetyFault::stale_sample);
  CHECK(report.device_fault == device::DeviceFault::none);
  CHECK(report.ticks >= 100 + 8);
  CHECK(report.ticks <= 100 + 12);
}

TEST_CASE("a Falcon whose answers make no sense is bad data") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.emulator.shorten_replies(1'000'000, 9);
  rig.lockstep.steps(FalconExchange::kLostAfter);
  CHECK(rig.device->fault() == device::DeviceFault::bad_data);
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
  rig.lockstep.steps(FalconExchange::kMaxJumps);
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

TEST_CASE("closing sends packets without force and switches the lights off") {
  Rig rig(true);
  rig.lockstep.steps(2);
  rig.push({0.0, 0.0, 1.0});
  REQUIRE(rig.emulator.motors() != kNoMotors);
  const std::uint64_t before = rig.emulator.exchanges();
  rig.device.reset();
  CHECK(rig.emulator.motors() == kNoMotors);
  CHECK(rig.emulator.lamps() == Lamps{});
  CHECK(rig.emulator.exchanges() >= before + FalconDevice::kFinalPackets);
  CHECK(rig.emulator.complaints().empty());
}

TEST_CASE("a firmware that does not run is reported") {
  const TempFolder folder;
  FalconEmulator emulator({.boot_loader = {.image = {1, 2, 3}}});
  device::FalconSettings settings{.firmware = write_dummy_firmware(folder.path())};
  CHECK_THROWS_WITH(FalconDevice(std::make_unique<EmulatorTransport>(emulator), settings),
                    names("falcon.firmware"));
}

TEST_CASE("a Falcon describes itself") {
  Rig rig(true);
  const device::DeviceInfo info = rig.device->info();
  CHECK(info.name == "falcon");
  CHECK(info.serial == "EMULATED");
  CHECK(info.max_force_n == Approx(6.51).margin(0.01));
  CHECK(info.continuous_force_n == Approx(2.17).margin(0.01));
  CHECK_FALSE(info.simulated);
  REQUIRE(info.workspace);
  REQUIRE(info.workspace->shape == device::WorkspaceShape::ellipsoid);
  CHECK(info.workspace->min_mm == Vec3{-40.0, -40.0, -40.0});
  // Every place on the ball is in reach.
  for (double turn = 0.0; turn < 6.3; turn += 0.1) {
    for (double rise = -1.5; rise < 1.6; rise += 0.1) {
      const Vec3 place_mm{40.0 * std::cos(rise) * std::cos(turn), 40.0 * std::sin(rise),
                          40.0 * std::cos(rise) * std::sin(turn)};
      CHECK(reference_theta1(to_native_m(place_mm)).has_value());
    }
  }
}

}  // namespace
}  // namespace touchtrial::device::falcon
