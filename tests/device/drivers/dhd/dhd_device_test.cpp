#include "device/drivers/dhd/dhd_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/dhd/dhd_gravity.hpp"
#include "device/drivers/registry.hpp"
#include "device/fakes/loaded_fake.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

namespace touchtrial {
namespace {

using namespace device;
using fakes::eventually;
using fakes::LoadedDhd;
using fakes::next_sample;
using fakes::write_until;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kGravityMS2 = 9.80665;

DhdSettings settings_of_fake() {
  return {.library = TOUCHTRIAL_FAKE_DHD};
}

/// Opens a device whose readings happen in the fake's time, so that velocities do not depend on the
/// machine's pace.
device::DhdDevice opened(const LoadedDhd& fake, const DhdSettings& settings = settings_of_fake()) {
  return device::DhdDevice(settings, kNoLimit, fake.exports().now);
}

/// Waits until force is on, and one reading more.
DeviceSample ready_sample(HapticDevice& device) {
  DeviceSample sample;
  REQUIRE(eventually([&] {
    (void)device.read(sample);
    return sample.ready;
  }));
  return next_sample(device);
}

/// The device frame's y is up, DHD's z.
double up_n(const LoadedDhd& fake) {
  return fake->force_n.get().z;
}

TEST_CASE("dhd: position, velocity and buttons arrive in the device frame, in millimetres") {
  LoadedDhd fake;
  fake->hand.rest_at({30.0, 10.0, -20.0});  // towards the person, to the right, up
  fake->buttons = 5;
  device::DhdDevice device = opened(fake);
  const DeviceSample sample = ready_sample(device);
  CHECK(norm(sample.position_mm - Vec3{10.0, -20.0, 30.0}) < 1e-12);
  CHECK(sample.velocity_mm_s == Vec3{});
  CHECK(sample.buttons == 5);
  CHECK(sample.ready);
}

TEST_CASE("dhd: the velocity is the hand's, in the device frame") {
  LoadedDhd fake;
  fake->hand.push_n.set({0.008, 0.0, -0.016});  // through oil: 1 mm/s and -2 mm/s
  device::DhdDevice device = opened(fake);
  // The line goes through nine readings.
  for (int i = 0; i < 5; ++i) (void)next_sample(device);
  CHECK(norm(next_sample(device).velocity_mm_s - Vec3{0.0, -2.0, 1.0}) < 1e-6);
}

TEST_CASE("dhd: mass, time guard, watchdog and largest force are set, and put back in the end") {
  LoadedDhd fake;
  fake->own_mass_kg = 0.1;
  fake->watchdog = 200;
  DhdSettings settings = settings_of_fake();
  settings.effector_mass_kg = GENERATE(0.0, 0.125);
  settings.gravity_compensation = GENERATE(true, false);
  {
    const device::DhdDevice device = opened(fake, settings);
    CHECK(fake->effector_mass_kg == (settings.effector_mass_kg > 0.0 ? 0.125 : -1.0));
    CHECK(fake->time_guard_us == -1);
    CHECK(fake->gravity_compensation == (settings.gravity_compensation ? 1 : 0));
    // The weight has room beyond the model's 12 N.
    CHECK(fake->max_force_n == (settings.gravity_compensation ? Approx(18.2) : Approx(12.0)));
    CHECK(fake->watchdog == 80);
  }
  CHECK(fake->effector_mass_kg == (settings.effector_mass_kg > 0.0 ? 0.1 : -1.0));
  CHECK(fake->watchdog == 200);
}

TEST_CASE("dhd: the library holds the lab's limit behind the safety chain, beside the weight") {
  LoadedDhd fake;
  fake->arm_mass_kg = 0.4;
  fake->limits_sum = GENERATE(false, true);
  DeviceSettings settings;
  settings.dhd.library = TOUCHTRIAL_FAKE_DHD;
  settings.uses["dhd"].limits.max_force_n = 2.5;
  const auto device = device::open_device("dhd", settings);
  CHECK(fake->max_force_n == Approx(2.5 + 6.2));
  const double whole_n = 2.5 + kGravityMS2 * 0.4;
  CHECK(
      write_until(*device, {0.0, 2.5, 0.0}, [&] { return std::abs(up_n(fake) - whole_n) < 1e-9; }));
  CHECK(write_until(*device, {0.0, 40.0, 0.0}, [&] { return up_n(fake) > whole_n; }));
  CHECK(up_n(fake) <= Approx(fake->limits_sum ? 8.7 : 8.7 + kGravityMS2 * 0.4));
}

TEST_CASE("dhd: the library carries arms and end-effector, whatever force is commanded") {
  LoadedDhd fake;
  fake->arm_mass_kg = 0.2;
  fake->own_mass_kg = 0.1;
  DhdSettings settings = settings_of_fake();
  double mass_kg = 0.3;
  SECTION("as the device knows them") {}
  SECTION("with another end-effector") {
    settings.effector_mass_kg = 0.15;
    mass_kg = 0.35;
  }
  device::DhdDevice device = opened(fake, settings);
  const DeviceSample sample = ready_sample(device);
  CHECK(std::abs(up_n(fake) - kGravityMS2 * mass_kg) < 1e-9);
  CHECK(write_until(device, {0.0, 1.0, 0.0},
                    [&] { return std::abs(up_n(fake) - kGravityMS2 * mass_kg - 1.0) < 1e-9; }));
  // The servo adds none.
  CHECK(device.support_force_n(sample) == Vec3{});
  CHECK(fake->misuses == 0);
}

TEST_CASE(
    "dhd: without compensation, force is switched on once the library has removed the weight") {
  LoadedDhd fake;
  fake->arm_mass_kg = 0.3;
  DhdSettings settings = settings_of_fake();
  SECTION("as set") {
    settings.gravity_compensation = false;
  }
  SECTION("on a Falcon, whose force nothing switches off") {
    fake->system_type = 60;
  }
  device::DhdDevice device = opened(fake, settings);
  double max_n = 0.0;
  REQUIRE(eventually([&] {
    max_n = std::max(max_n, up_n(fake));
    return fake.calls() == "open force_off force_on ";
  }));
  (void)ready_sample(device);
  CHECK(max_n == 0.0);
  CHECK(up_n(fake) == 0.0);
  CHECK(write_until(device, {0.0, 1.0, 0.0}, [&] { return up_n(fake) == 1.0; }));
}

TEST_CASE("dhd: a mass that cannot be true is refused before any force") {
  LoadedDhd fake;
  fake->own_mass_kg = 0.12;
  DhdSettings settings = settings_of_fake();
  settings.effector_mass_kg = 1.2;
  CHECK_THROWS_WITH(device::DhdDevice(settings),
                    names("dhd.effector_mass_kg 1.2") && names("0.12") && holds_text("10.6 N"));
  CHECK(fake->effector_mass_kg == -1.0);
  CHECK(fake.calls() == "open force_off close ");
  DeviceSettings listed;
  listed.dhd = settings;
  const std::vector<DeviceListing> listings = device::device_driver("dhd").list(listed);
  REQUIRE(listings.at(0).missing.size() == 1);
  CHECK_THAT(listings[0].missing[0], holds_text("dhd.effector_mass_kg"));
}

TEST_CASE("dhd: an end-effector that weighs more than the model with its arms is refused") {
  LoadedDhd fake;
  fake->own_mass_kg = GENERATE(0.7, -0.1);
  CHECK_THROWS_WITH(device::DhdDevice(settings_of_fake()),
                    holds_text("dhd.effector_mass_kg") && holds_text("omega.3"));
  CHECK(fake.calls() == "open force_off close ");
  DhdSettings settings = settings_of_fake();
  settings.gravity_compensation = false;
  CHECK_NOTHROW(opened(fake, settings));
}

TEST_CASE("dhd: an implausible weight is refused, or a fault before force is switched on") {
  LoadedDhd fake;
  SECTION("it points down and sideways") {
    fake->weight_is_nonsense = true;
  }
  SECTION("it is too large for an omega.3") {
    fake->arm_mass_kg = 0.7;
  }
  CHECK_THROWS_WITH(device::DhdDevice(settings_of_fake()), holds_text("dhd.gravity_compensation"));
  fake->calibrated = false;
  device::DhdDevice device = opened(fake);
  (void)next_sample(device);
  CHECK(device.fault() == DeviceFault::none);
  fake->calibrated = true;
  REQUIRE(eventually([&] { return device.fault() == DeviceFault::bad_data; }));
  CHECK(fake.calls().find("force_on") == std::string::npos);
  CHECK(fake->misuses == 0);
}

TEST_CASE("dhd: a weight is finite, points up, and is no larger than the model's") {
  using device::dhd::is_plausible_weight;
  CHECK(is_plausible_weight({}, 6.2));
  CHECK(is_plausible_weight({-0.9, 0.6, 4.1}, 6.2));  // on a base that is not level
  CHECK_FALSE(is_plausible_weight({0.0, 0.0, 6.3}, 6.2));
  CHECK_FALSE(is_plausible_weight({0.0, 2.0, 4.1}, 6.2));
  CHECK_FALSE(is_plausible_weight({0.0, 0.0, -0.3}, 6.2));
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  CHECK_FALSE(is_plausible_weight({0.0, 0.0, bad}, 6.2));
  CHECK_FALSE(is_plausible_weight({bad, 0.0, 4.1}, 6.2));
}

TEST_CASE("dhd: the weight is also read with the functions of newer libraries") {
  const fakes::LoadedDrd fake;
  DhdSettings settings{.library = TOUCHTRIAL_FAKE_DRD};
  fake->arm_mass_kg = 0.3;
  CHECK(device::DhdDevice(settings).fault() == DeviceFault::none);
  fake->arm_mass_kg = 0.7;
  CHECK_THROWS_WITH(device::DhdDevice(settings), holds_text("dhd.gravity_compensation"));
  CHECK(fake->misuses == 0);
}

TEST_CASE("dhd: heavy models are carried too, within a limit of their own") {
  LoadedDhd fake;
  const auto [type, weight_n] = GENERATE(table<int, double>(
      {{33, 4.2}, {110, 4.2}, {35, 7.3}, {63, 6.0}, {111, 6.0}, {104, 15.0}, {109, 17.8}}));
  fake->system_type = type;
  fake->arm_mass_kg = weight_n / kGravityMS2;
  {
    device::DhdDevice device = opened(fake);
    (void)ready_sample(device);
    CHECK(up_n(fake) == Approx(weight_n));
  }
  fake->arm_mass_kg = 2.0 * weight_n / kGravityMS2;
  CHECK_THROWS_AS(device::DhdDevice(settings_of_fake()), DeviceError);
}

TEST_CASE("dhd: a setting that the device refuses is named, and the device closed") {
  LoadedDhd fake;
  fake->refuses_mass = true;
  DhdSettings settings = settings_of_fake();
  settings.effector_mass_kg = 0.1;
  CHECK_THROWS_AS(device::DhdDevice(settings), DeviceError);
  CHECK_THROWS_WITH(device::DhdDevice(settings),
                    names("dhd.effector_mass_kg") && holds_text("fake words"));
  CHECK(fake.calls() == "open force_off force_off close open force_off force_off close ");
}

TEST_CASE("dhd: the device describes itself, and its model gives size and strength") {
  LoadedDhd fake;
  const DeviceInfo info = device::DhdDevice(settings_of_fake()).info();
  CHECK(info.name == "dhd");
  CHECK(info.model == "omega.3");
  CHECK(info.serial == "4242");
  CHECK(info.firmware == "3.5");
  CHECK(info.library == "3.17.5.1900");
  // The maker's data sheet: a cylinder of 160 mm, 110 mm long; 12 N.
  CHECK(info.max_force_n == 12.0);
  CHECK(info.continuous_force_n == 12.0);
  CHECK(info.max_stiffness_n_per_mm == 5.0);
  REQUIRE(info.workspace);
  CHECK(info.workspace->min_mm == Vec3{-80.0, -80.0, -55.0});
  CHECK(info.workspace->max_mm == Vec3{80.0, 80.0, 55.0});
  CHECK(info.workspace->shape == WorkspaceShape::ellipsoid);
  CHECK_FALSE(info.simulated);
}

TEST_CASE("dhd: size and strength differ by model, and the settings come first") {
  LoadedDhd fake;
  fake->system_type = 63;  // delta.3: 400 mm, 260 mm long; 20 N
  CHECK(device::DhdDevice(settings_of_fake()).info().workspace->max_mm ==
        Vec3{200.0, 200.0, 130.0});
  DhdSettings settings = settings_of_fake();
  settings.max_force_n = 10.0;
  settings.continuous_force_n = 5.0;
  settings.workspace_mm = Vec3{300.0, 200.0, 100.0};
  const DeviceInfo info = device::DhdDevice(settings).info();
  CHECK(info.max_force_n == 10.0);
  CHECK(info.continuous_force_n == 5.0);
  CHECK(info.workspace->max_mm == Vec3{150.0, 100.0, 50.0});
}

TEST_CASE("dhd: a force that the model does not have, or a model without numbers, is refused") {
  LoadedDhd fake;
  DhdSettings settings = settings_of_fake();
  SECTION("too strong") {
    settings.max_force_n = 13.0;
    CHECK_THROWS_WITH(device::DhdDevice(settings), names("13 12"));
  }
  SECTION("an unknown model") {
    fake->system_type = 91;
    CHECK_THROWS_WITH(device::DhdDevice(settings), names("dhd.max_force_n"));
    settings.max_force_n = 4.0;
    CHECK_THROWS_WITH(device::DhdDevice(settings), names("dhd.workspace_mm"));
    settings.workspace_mm = Vec3{100.0, 100.0, 100.0};
    CHECK(device::DhdDevice(settings).info().max_force_n == 4.0);
  }
}

TEST_CASE(
    "dhd: a library without names and expert mode works, one without another function does not") {
  DhdSettings settings{
      .library = TOUCHTRIAL_OLD_DHD, .max_force_n = 4.0, .workspace_mm = Vec3{100.0, 100.0, 100.0}};
  CHECK(device::DhdDevice(settings).info().model == "Force Dimension device");
  {
    device::DhdDevice device(settings);
    (void)ready_sample(device);
  }
  // Without a model of the arms only the end-effector's mass can be judged: half of the peak force.
  settings.effector_mass_kg = 0.15;
  CHECK(device::DhdDevice(settings).info().max_force_n == 4.0);
  settings.max_force_n = 2.0;
  settings.effector_mass_kg = 0.19;
  CHECK_THROWS_WITH(device::DhdDevice(settings), holds_text("dhd.effector_mass_kg"));
  settings.library = TOUCHTRIAL_PARTIAL_DHD;
  CHECK_THROWS_WITH(device::DhdDevice(settings), names("dhdEnableForce"));
  settings.library = "/nowhere/libdhd.so";
  CHECK_THROWS_WITH(device::DhdDevice(settings),
                    holds_text("/nowhere/libdhd.so") && holds_text("dhd.library"));
}

/// The kit's folders, with versions as it has them. A link is the same library to the system.
class Kit {
 public:
  Kit() {
    std::filesystem::create_directories(libraries());
    add(TOUCHTRIAL_FAKE_DHD, "libdhd.so.3.9.0");
    add(TOUCHTRIAL_FAKE_DHD, "libdhd.so.3.17.6");
    add(TOUCHTRIAL_FAKE_DHD, "libdhd.a");
  }
  void add(const std::filesystem::path& library, const std::string& name) const {
    std::filesystem::create_symlink(library, libraries() / name);
  }
  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }
  [[nodiscard]] std::filesystem::path libraries() const {
    return folder_.path() / "lib" / "release" / "lin-x86_64-gcc";
  }

 private:
  TempFolder folder_;
};

std::string library_found(const std::filesystem::path& named) {
  DeviceSettings settings;
  settings.dhd.library = named;
  const std::string where = device::device_driver("dhd").list(settings).at(0).where;
  return std::filesystem::path(where.substr(0, where.find(','))).filename().string();
}

TEST_CASE("dhd: the newest library of the kit's folder is used, and libdrd before libdhd") {
  const LoadedDhd fake;
  const Kit kit;
  CHECK(library_found(kit.folder()) == "libdhd.so.3.17.6");
  CHECK(library_found(kit.libraries()) == "libdhd.so.3.17.6");
  CHECK(library_found(kit.libraries() / "libdhd.so.3.9.0") == "libdhd.so.3.9.0");
  const fakes::LoadedDrd drd;
  kit.add(TOUCHTRIAL_FAKE_DRD, "libdrd.so.3.9.0");
  CHECK(library_found(kit.folder()) == "libdrd.so.3.9.0");
}

TEST_CASE("dhd: a kit that the environment names is found without any setting") {
  const LoadedDhd fake;
  const Kit kit;
  const EnvironmentVariable named("FDSDK", kit.folder().c_str());
  CHECK(library_found("libdhd.so") == "libdhd.so.3.17.6");
}

TEST_CASE("dhd: a folder without a library is named, with the remedy") {
  const TempFolder empty;
  DhdSettings settings{.library = empty.path()};
  CHECK_THROWS_WITH(device::DhdDevice(settings), names(empty.path().string() + " dhd.library"));
}

TEST_CASE("dhd: a device that is missing, or does not open, is reported with the remedy") {
  LoadedDhd fake;
  DhdSettings settings = settings_of_fake();
  SECTION("fewer devices") {
    settings.index = 1;
    CHECK_THROWS_WITH(device::DhdDevice(settings), names("1 1"));
    CHECK(fake.calls().empty());
  }
  SECTION("none that opens") {
    fake->opens = false;
    CHECK_THROWS_WITH(device::DhdDevice(settings), holds_text("fake words"));
    CHECK(fake.calls() == "open ");
  }
}

TEST_CASE("dhd: a device that waits for its calibration gets no force, and none is switched on") {
  LoadedDhd fake;
  fake->calibrated = false;
  device::DhdDevice device = opened(fake);
  CHECK_FALSE(next_sample(device).ready);
  CHECK(device.readiness() == DeviceReadiness::needs_calibration);
  const long begun = fake->polls;
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->polls > begun + 50; }));
  CHECK(fake->zero_forces_last >= 50);
  CHECK(fake.calls() == "open force_off ");
  fake->calibrated = true;
  CHECK(write_until(device, {0.0, 1.0, 0.0}, [&] { return up_n(fake) == 1.0; }));
  CHECK(device.readiness() == DeviceReadiness::ready);
}

TEST_CASE("dhd: a device that loses its calibration is not ready, and its force is off") {
  LoadedDhd fake;
  device::DhdDevice device = opened(fake);
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return up_n(fake) == 1.0; }));
  fake->calibrated = false;
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->brakes.load(); }));
  CHECK_FALSE(next_sample(device).ready);
  CHECK(device.readiness() == DeviceReadiness::needs_calibration);
  CHECK(device.fault() == DeviceFault::none);
}

TEST_CASE("dhd: a device whose force only its button switches on asks a person to press it") {
  LoadedDhd fake;
  fake->wants_button = true;
  device::DhdDevice device = opened(fake);
  REQUIRE(eventually([&] { return device.readiness() == DeviceReadiness::needs_force_on; }));
  CHECK_FALSE(next_sample(device).ready);
  fake.exports().press_force_button();
  CHECK(write_until(device, {0.0, 1.0, 0.0}, [&] { return up_n(fake) == 1.0; }));
  CHECK(device.readiness() == DeviceReadiness::ready);
}

TEST_CASE("dhd: a device at which a person switches force off is not ready, without a fault") {
  LoadedDhd fake;
  device::DhdDevice device = opened(fake);
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return up_n(fake) == 1.0; }));
  const int cause = GENERATE(1, 4, 6);
  fake.exports().force_off(cause);
  REQUIRE(eventually([&] { return device.readiness() == DeviceReadiness::needs_force_on; }));
  CHECK_FALSE(next_sample(device).ready);
  CHECK(device.fault() == DeviceFault::none);
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->zero_forces_last > 10; }));
  fake.exports().press_force_button();
  CHECK(write_until(device, {0.0, 1.0, 0.0}, [&] { return up_n(fake) == 1.0; }));
}

TEST_CASE("dhd: force that the device itself switches off is a fault by its cause") {
  const auto [cause, fault] = GENERATE(table<int, DeviceFault>(
      {{2, DeviceFault::limit_passed}, {3, DeviceFault::driver}, {5, DeviceFault::link_lost}}));
  LoadedDhd fake;
  device::DhdDevice device = opened(fake);
  (void)ready_sample(device);
  fake.exports().force_off(cause);
  CHECK(eventually([&] { return device.fault() != DeviceFault::none; }));
  CHECK(device.fault() == fault);
}

TEST_CASE("dhd: a force switch-off in an earlier program is not a fault") {
  LoadedDhd fake;
  fake->force_off_cause = GENERATE(2, 3, 5);
  fake->wants_button = GENERATE(true, false);
  device::DhdDevice device = opened(fake);
  for (int i = 0; i < 100; ++i) (void)next_sample(device);
  CHECK(device.fault() == DeviceFault::none);
}

TEST_CASE(
    "dhd: a failure while the device is connected is the driver's, otherwise the link is lost") {
  LoadedDhd fake;
  device::DhdDevice device = opened(fake);
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return up_n(fake) == 1.0; }));
  DeviceFault expected = DeviceFault::driver;
  SECTION("a position that cannot be read") {
    fake->position_fails = true;
  }
  SECTION("an error in the status") {
    fake->device_error = true;
  }
  SECTION("unplugged") {
    fake->connected = false;
    expected = DeviceFault::link_lost;
  }
  SECTION("a position that is not a number") {
    fake->hand.rest_at({0.0, std::numeric_limits<double>::infinity(), 0.0});
    expected = DeviceFault::bad_data;
  }
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->zero_forces_last > 10; }));
  CHECK(device.fault() == expected);
  DeviceSample sample;
  CHECK(device.read(sample) == DeviceStatus::fault);
  CHECK(is_finite(sample.position_mm));
  CHECK(device.write({}) == DeviceStatus::fault);
}

TEST_CASE("dhd: no reading is new while the library exchanges nothing with the device") {
  LoadedDhd fake;
  device::DhdDevice device = opened(fake);
  (void)ready_sample(device);
  fake->exchanges = false;
  const long begun = fake->polls;
  REQUIRE(eventually([&] { return fake->polls > begun + 10; }));
  DeviceSample sample;
  REQUIRE(device.read(sample) == DeviceStatus::ok);
  const std::uint64_t last = sample.sequence;
  REQUIRE(eventually([&] { return fake->polls > begun + 60; }));
  CHECK(device.read(sample) == DeviceStatus::ok);
  CHECK(sample.sequence == last);
  fake->exchanges = true;
  CHECK(next_sample(device).sequence > last);
}

TEST_CASE("dhd: saturated motors are not a fault, and are reported to the servo") {
  LoadedDhd fake;
  fake->saturated = true;
  device::DhdDevice device = opened(fake);
  REQUIRE(eventually([&] { return fake->polls > 100; }));
  CHECK(device.fault() == DeviceFault::none);
  CHECK(next_sample(device).limited);
  fake->saturated = false;
  CHECK_FALSE(next_sample(device).limited);
}

TEST_CASE("dhd: halting switches force off and the brakes on, until it is re-armed") {
  LoadedDhd fake;
  fake->own_mass_kg = 0.3;
  device::DhdDevice device = opened(fake);
  REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
  device.halt();
  REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->brakes.load(); }));
  const long begun = fake->polls;
  REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->polls > begun + 20; }));
  CHECK(fake->force_n.get() == Vec3{});  // nor the weight
  CHECK(fake->zero_forces_last > 10);
  CHECK(device.readiness() == DeviceReadiness::ready);
  device.rearm();
  CHECK(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
}

TEST_CASE("dhd: a device that a session opens halted is ready, and pushes only once re-armed") {
  LoadedDhd fake;
  fake->own_mass_kg = 0.3;
  device::DhdDevice device = opened(fake);
  device.halt();
  REQUIRE(eventually([&] { return device.readiness() == DeviceReadiness::ready; }));
  const long begun = fake->polls;
  REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->polls > begun + 50; }));
  CHECK(fake->force_n.get() == Vec3{});
  device.rearm();
  CHECK(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
}

/// A run of the servo in the fake's time, against a hand that bears a press of 1.2 N; the press
/// grows within 0.3 s, so that the servo engages.
/// \param tremble_n  of the hand
ServoReport pressed(LoadedDhd& fake, HapticDevice& device, double tremble_n) {
  constexpr double kPressN = 1.2;
  PlacedDevice placed(device, {});
  ForceBy press([&, ticks = 0](const DeviceSample& /*sample*/) mutable {
    const double tremble = ++ticks % 2 == 0 ? tremble_n : -tremble_n;
    fake->hand.push_n.set({0.0, 0.0, tremble - kPressN});
    return Vec3{0.0, 0.0, std::min(kPressN, 0.004 * ticks)};
  });
  NoSamples none;
  fakes::SteppingClock clock(fake.exports());
  return device::run_servo(placed, press, none, {.limit_ticks = 5000, .fade_ticks = 0}, clock);
}

TEST_CASE("dhd: a position that stands still to the last bit under a press ends a run") {
  LoadedDhd fake;
  device::DhdDevice device = opened(fake);
  (void)ready_sample(device);
  const ServoReport report = pressed(fake, device, 0.0);
  CHECK(report.end == ServoEnd::fault);
  CHECK(report.fault == SafetyFault::frozen_encoders);
  CHECK(report.ticks > 500);
  CHECK(eventually([&] { return fake->force_n.get() == Vec3{}; }));
}

TEST_CASE("dhd: a hand that keeps as still under a press as a hand can is no fault") {
  LoadedDhd fake;
  device::DhdDevice device = opened(fake);
  (void)ready_sample(device);
  CHECK(pressed(fake, device, 0.1).end == ServoEnd::time_limit);
  CHECK(device.fault() == DeviceFault::none);
}

TEST_CASE("dhd: a fault switches force off and the brakes on") {
  LoadedDhd fake;
  device::DhdDevice device = opened(fake);
  REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
  fake->device_error = true;
  REQUIRE(eventually([&] { return fake->brakes.load(); }));
  CHECK(fake->force_n.get() == Vec3{});
}

TEST_CASE("dhd: closing sends zeros, switches force off, and closes the device") {
  LoadedDhd fake;
  {
    device::DhdDevice device = opened(fake);
    REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
  }
  CHECK(fake->zero_forces_last >= 5);
  CHECK(fake->misuses == 0);
  CHECK(fake.calls() == "open force_off force_on stop force_off close ");
}

std::vector<DeviceListing> listings_with(const std::filesystem::path& library) {
  DeviceSettings settings;
  settings.dhd.library = library;
  return device::device_driver("dhd").list(settings);
}

TEST_CASE("the list of dhd names every connected device, and closes it") {
  fakes::LoadedDhd fake;
  fake->devices = 2;
  const std::vector<DeviceListing> listings = listings_with(TOUCHTRIAL_FAKE_DHD);
  REQUIRE(listings.size() == 2);
  for (const DeviceListing& listing : listings) {
    CHECK(listing.driver == "dhd");
    CHECK(listing.present);
    CHECK(listing.model == "omega.3");
    CHECK(listing.serial == "4242");
    CHECK(listing.missing.empty());
  }
  CHECK_THAT(listings[1].where, names(" 1"));
  CHECK(fake->misuses == 0);
  CHECK(fake.calls() == "open force_off close open force_off close ");
}

std::string initialised_with(const std::filesystem::path& library) {
  DeviceSettings settings;
  settings.dhd.library = library;
  return device::device_driver("dhd").initialise(settings);
}

TEST_CASE("dhd: a device is initialised by libdrd alone, and only if it is not yet") {
  const fakes::LoadedDrd fake;
  fake->calibrated = false;
  const std::string moved = initialised_with(TOUCHTRIAL_FAKE_DRD);
  CHECK(fake.calls() == "drd open auto_init force_off drd close ");
  CHECK(initialised_with(TOUCHTRIAL_FAKE_DRD) != moved);
  CHECK(fake.calls() == "drd open auto_init force_off drd close drd open force_off drd close ");
}

TEST_CASE(
    "dhd: an initialisation that fails, or that the library does not have, names the rest "
    "position") {
  const fakes::LoadedDrd drd;
  drd->calibrated = false;
  drd->auto_init_fails = true;
  CHECK_THROWS_WITH(initialised_with(TOUCHTRIAL_FAKE_DRD), holds_text("fake words"));
  const fakes::LoadedDhd dhd;
  dhd->calibrated = false;
  CHECK_THROWS_WITH(initialised_with(TOUCHTRIAL_FAKE_DHD), names("libdrd.so"));
}

TEST_CASE("the list of dhd names what is missing, with the remedy") {
  struct Lack {
    const char* library;
    bool present;
    const char* missing;
    std::function<void(fakes::FakeDhd&)> change;
  };
  const auto typed = [](int type) {
    return [type](fakes::FakeDhd& fake) { fake.system_type = type; };
  };
  const auto none = [](fakes::FakeDhd& fake) { fake.devices = 0; };
  for (const Lack& lack : {
           Lack{TOUCHTRIAL_FAKE_DHD, false, "", none},
           Lack{"/nowhere/libdhd.so", false, "/nowhere/libdhd.so", none},
           Lack{TOUCHTRIAL_PARTIAL_DHD, false, "dhdEnableForce", none},
           Lack{TOUCHTRIAL_FAKE_DHD, true, "fake words",
                [](fakes::FakeDhd& fake) { fake.opens = false; }},
           Lack{TOUCHTRIAL_FAKE_DHD, true, "touchtrial device initialise dhd",
                [](fakes::FakeDhd& fake) { fake.calibrated = false; }},
           Lack{TOUCHTRIAL_FAKE_DHD, true, "dhd.max_force_n", typed(203)},
           Lack{TOUCHTRIAL_FAKE_DHD, true, "dhd.max_force_n", typed(206)},
           Lack{TOUCHTRIAL_FAKE_DHD, true, "dhd.max_force_n", typed(91)},
       }) {
    INFO(lack.library << " " << lack.missing);
    const fakes::LoadedDhd fake;
    lack.change(*fake.exports().state);
    const std::vector<DeviceListing> listings = listings_with(lack.library);
    REQUIRE(listings.size() == 1);
    CHECK(listings[0].present == lack.present);
    REQUIRE(listings[0].missing.size() == 1);
    CHECK_THAT(listings[0].missing[0], holds_text(lack.missing));
  }
}

}  // namespace

}  // namespace touchtrial
