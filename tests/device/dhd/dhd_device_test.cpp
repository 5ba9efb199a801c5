#include "device/dhd/dhd_device.hpp"

#include "core/errors.hpp"
#include "device/fakes/loaded_fake.hpp"
#include "device/registry.hpp"
#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

using fakes::eventually;
using fakes::LoadedDhd;
using fakes::next_sample;
using fakes::write_until;

device::DhdSettings settings_of_fake() {
  device::DhdSettings settings;
  settings.library = TOUCHTRIAL_FAKE_DHD;
  return settings;
}

TEST_CASE("dhd: position, velocity and buttons arrive in the device frame, in millimetres") {
  LoadedDhd fake;
  fake->hand.rest_at({30.0, 10.0, -20.0});  // towards the person, to the right, up
  fake->buttons = 5;
  device::DhdDevice device(settings_of_fake());
  const device::DeviceSample sample = next_sample(device);
  CHECK(norm(sample.position_mm - Vec3{10.0, -20.0, 30.0}) < 1e-12);
  CHECK(sample.velocity_mm_s == Vec3{});
  CHECK(sample.buttons == 5);
  CHECK(sample.ready);
}

TEST_CASE("dhd: a force in the device frame reaches the library in its own") {
  LoadedDhd fake;
  device::DhdDevice device(settings_of_fake());
  CHECK(write_until(device, {1.0, 2.0, 3.0}, [&] {
    return fake->force_n.get() == Vec3{3.0, 1.0, 2.0};
  }));
}

TEST_CASE("dhd: the velocity is the hand's, in the device frame") {
  LoadedDhd fake;
  fake->hand.push_n.set({0.008, 0.0, -0.016});  // through oil: 1 mm/s and -2 mm/s
  device::DhdDevice device(settings_of_fake());
  CHECK(norm(next_sample(device).velocity_mm_s - Vec3{0.0, -2.0, 1.0}) < 1e-9);
}

TEST_CASE("dhd: a wall carries the hand that pushes against it") {
  LoadedDhd fake;
  fake->hand.position_mm.set({0.0, 5.0, 3.0});
  fake->hand.push_n.set({0.0, 0.0, -0.7});
  device::DhdDevice device(settings_of_fake());
  fakes::WallRun(device, fake.exports()).check_carries_hand();
}

TEST_CASE("dhd: gravity compensation, mass and time guard follow the settings") {
  LoadedDhd fake;
  device::DhdSettings settings = settings_of_fake();
  settings.gravity_compensation = GENERATE(true, false);
  settings.effector_mass_kg = GENERATE(0.0, 0.125);
  device::DhdDevice device(settings);
  CHECK(fake->gravity_compensation == (settings.gravity_compensation ? 1 : 0));
  CHECK(fake->effector_mass_kg == (settings.effector_mass_kg > 0.0 ? 0.125 : -1.0));
  CHECK(fake->time_guard_us == -1);
}

TEST_CASE("dhd: a setting that the device refuses is named, and the device closed") {
  LoadedDhd fake;
  fake->refuses_mass = true;
  device::DhdSettings settings = settings_of_fake();
  settings.effector_mass_kg = 50.0;
  CHECK_THROWS_AS(device::DhdDevice(settings), DeviceError);
  CHECK_THROWS_WITH(device::DhdDevice(settings),
                    holds_text("dhd.effector_mass_kg was refused: fake words"));
  CHECK(fake.calls() == "open force_off close open force_off close ");
}

TEST_CASE("dhd: the device describes itself") {
  LoadedDhd fake;
  device::DhdSettings settings = settings_of_fake();
  settings.max_force_n = 12.0;
  settings.continuous_force_n = 5.0;
  const device::DeviceInfo info = device::DhdDevice(settings).info();
  CHECK(info.name == "dhd");
  CHECK(info.model == "omega.3");
  CHECK(info.serial == "4242");
  CHECK(info.firmware == "2.5");
  CHECK(info.max_force_n == 12.0);
  CHECK(info.continuous_force_n == 5.0);
  CHECK_FALSE(info.simulated);
}

TEST_CASE(
    "dhd: a library without names and expert mode works, one without another function does not") {
  device::DhdSettings settings;
  settings.library = TOUCHTRIAL_OLD_DHD;
  CHECK(device::DhdDevice(settings).info().model == "Force Dimension device");
  settings.library = TOUCHTRIAL_PARTIAL_DHD;
  CHECK_THROWS_WITH(device::DhdDevice(settings), holds_text("has no function dhdEnableForce"));
  settings.library = "/nowhere/libdhd.so";
  CHECK_THROWS_WITH(device::DhdDevice(settings),
                    holds_text("/nowhere/libdhd.so") && holds_text("dhd.library"));
}

TEST_CASE("dhd: a device that is missing, or does not open, is reported with the remedy") {
  LoadedDhd fake;
  device::DhdSettings settings = settings_of_fake();
  SECTION("fewer devices") {
    settings.index = 1;
    CHECK_THROWS_WITH(device::DhdDevice(settings), holds_text("no device 1 (1 connected"));
    CHECK(fake.calls().empty());
  }
  SECTION("none that opens") {
    fake->opens = false;
    CHECK_THROWS_WITH(device::DhdDevice(settings), holds_text("does not open: fake words"));
    CHECK(fake.calls() == "open ");
  }
}

TEST_CASE("dhd: without calibration the force stays zero") {
  LoadedDhd fake;
  fake->calibrated = false;
  device::DhdDevice device(settings_of_fake());
  CHECK_FALSE(next_sample(device).ready);
  CHECK(device.readiness() == device::DeviceReadiness::needs_calibration);
  const long begun = fake->polls;
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->polls > begun + 50; }));
  CHECK(fake->zero_forces_last >= 50);
  fake->calibrated = true;
  CHECK(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->force_n.get().z == 1.0; }));
  CHECK(device.readiness() == device::DeviceReadiness::ready);
}

TEST_CASE("dhd: a device at which a person switches force off is not ready, without a fault") {
  LoadedDhd fake;
  device::DhdDevice device(settings_of_fake());
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->force_n.get().z == 1.0; }));
  fake->force_off_cause = GENERATE(1, 4, 6);
  device::DeviceSample sample;
  REQUIRE(eventually([&] {
    (void)device.read(sample);
    return !sample.ready;
  }));
  CHECK(device.fault() == device::DeviceFault::none);
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->zero_forces_last > 10; }));
  fake->force_off_cause = 0;
  CHECK(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->force_n.get().z == 1.0; }));
}

TEST_CASE("dhd: force that the device itself switches off is a fault by its cause") {
  const auto [cause, fault] =
      GENERATE(table<int, device::DeviceFault>({{2, device::DeviceFault::limit_passed},
                                                {3, device::DeviceFault::driver},
                                                {5, device::DeviceFault::link_lost}}));
  LoadedDhd fake;
  device::DhdDevice device(settings_of_fake());
  (void)next_sample(device);
  fake->force_off_cause = cause;
  CHECK(eventually([&] { return device.fault() != device::DeviceFault::none; }));
  CHECK(device.fault() == fault);
}

TEST_CASE(
    "dhd: a failure while the device is connected is the driver's, otherwise the link is lost") {
  LoadedDhd fake;
  device::DhdDevice device(settings_of_fake());
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->force_n.get().z == 1.0; }));
  device::DeviceFault expected = device::DeviceFault::driver;
  SECTION("a position that cannot be read") {
    fake->position_fails = true;
  }
  SECTION("an error in the status") {
    fake->device_error = true;
  }
  SECTION("unplugged") {
    fake->connected = false;
    expected = device::DeviceFault::link_lost;
  }
  SECTION("a position that is not a number") {
    fake->hand.rest_at({0.0, std::numeric_limits<double>::infinity(), 0.0});
    expected = device::DeviceFault::bad_data;
  }
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->zero_forces_last > 10; }));
  CHECK(device.fault() == expected);
  device::DeviceSample sample;
  CHECK(device.read(sample) == device::DeviceStatus::fault);
  CHECK(is_finite(sample.position_mm));
  CHECK(device.write({}) == device::DeviceStatus::fault);
}

TEST_CASE("dhd: a device that is lost in the middle of a run ends it with a fault") {
  LoadedDhd fake;
  fake->hand.push_n.set({0.0, 0.0, -0.7});
  device::DhdDevice device(settings_of_fake());
  fakes::WallRun wall(device, fake.exports());
  REQUIRE(wall.run(50).end == device::ServoEnd::time_limit);
  fake->connected = false;
  CHECK(wall.run(50).end == device::ServoEnd::fault);
  CHECK(device.fault() == device::DeviceFault::link_lost);
}

TEST_CASE("dhd: the time guard's answer is neither a new reading nor a fault") {
  LoadedDhd fake;
  device::DhdDevice device(settings_of_fake());
  (void)next_sample(device);
  fake->too_soon = true;
  const long begun = fake->polls;
  REQUIRE(eventually([&] { return fake->polls > begun + 10; }));
  device::DeviceSample sample;
  REQUIRE(device.read(sample) == device::DeviceStatus::ok);
  const std::uint64_t last = sample.sequence;
  REQUIRE(eventually([&] { return fake->polls > begun + 60; }));
  CHECK(device.read(sample) == device::DeviceStatus::ok);
  CHECK(sample.sequence == last);
  fake->too_soon = false;
  CHECK(next_sample(device).sequence > last);
}

TEST_CASE("dhd: saturated motors are not a fault") {
  LoadedDhd fake;
  fake->saturated = true;
  device::DhdDevice device(settings_of_fake());
  REQUIRE(eventually([&] { return fake->polls > 100; }));
  CHECK(device.fault() == device::DeviceFault::none);
}

TEST_CASE("dhd: halting sends zero until it is re-armed") {
  LoadedDhd fake;
  device::DhdDevice device(settings_of_fake());
  REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
  device.halt();
  REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->zero_forces_last > 20; }));
  device.rearm();
  CHECK(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
}

TEST_CASE("dhd: closing sends zeros, switches force off, and closes the device") {
  LoadedDhd fake;
  {
    device::DhdDevice device(settings_of_fake());
    REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
  }
  CHECK(fake->zero_forces_last >= 5);
  CHECK(fake->misuses == 0);
  CHECK(fake.calls() == "open force_on force_off close ");
}

std::vector<device::DeviceListing> listings_with(const std::filesystem::path& library) {
  device::DeviceSettings settings;
  settings.dhd.library = library;
  return device::device_driver("dhd").list(settings);
}

TEST_CASE("the list of dhd names every connected device, and closes it") {
  fakes::LoadedDhd fake;
  fake->devices = 2;
  const std::vector<device::DeviceListing> listings = listings_with(TOUCHTRIAL_FAKE_DHD);
  REQUIRE(listings.size() == 2);
  for (const device::DeviceListing& listing : listings) {
    CHECK(listing.driver == "dhd");
    CHECK(listing.present);
    CHECK(listing.model == "omega.3");
    CHECK(listing.serial == "4242");
    CHECK(listing.missing.empty());
  }
  CHECK_THAT(listings[1].where, holds_text(", device 1"));
  CHECK(fake->misuses == 0);
  CHECK(fake.calls() == "open force_off close open force_off close ");
}

TEST_CASE("the list of dhd says what is missing: device, library, function, or access") {
  fakes::LoadedDhd fake;
  SECTION("no device, library or function") {
    fake->devices = 0;
    const auto [library, missing] = GENERATE(table<const char*, const char*>(
        {{TOUCHTRIAL_FAKE_DHD, "no device is connected"},
         {"/nowhere/libdhd.so", "install Force Dimension's SDK"},
         {TOUCHTRIAL_PARTIAL_DHD, "has no function dhdEnableForce"}}));
    const std::vector<device::DeviceListing> listings = listings_with(library);
    REQUIRE(listings.size() == 1);
    CHECK_FALSE(listings[0].present);
    REQUIRE(listings[0].missing.size() == 1);
    CHECK_THAT(listings[0].missing[0], holds_text(missing));
  }
  SECTION("a device that does not open") {
    fake->opens = false;
    const std::vector<device::DeviceListing> listings = listings_with(TOUCHTRIAL_FAKE_DHD);
    REQUIRE(listings.size() == 1);
    CHECK(listings[0].present);
    REQUIRE(listings[0].missing.size() == 1);
    CHECK_THAT(listings[0].missing[0], holds_text("close other programs"));
  }
}

TEST_CASE("dhd is opened through the registry by its name") {
  fakes::LoadedDhd fake;
  device::DeviceSettings settings;
  settings.dhd.library = TOUCHTRIAL_FAKE_DHD;
  CHECK(device::open_device("dhd", settings)->info().name == "dhd");
}

}  // namespace

}  // namespace touchtrial
