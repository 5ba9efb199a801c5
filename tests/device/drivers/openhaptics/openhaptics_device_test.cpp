#include "device/drivers/openhaptics/openhaptics_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/registry.hpp"
#include "device/fakes/loaded_fake.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <limits>
#include <optional>
#include <thread>

namespace touchtrial {
namespace {

using fakes::eventually;
using fakes::LoadedHd;
using fakes::next_sample;
using fakes::write_until;

device::OpenHapticsSettings settings_of_fake() {
  return {.library = TOUCHTRIAL_FAKE_HD};
}

TEST_CASE("openhaptics: the device is opened by the first of its default names that answers") {
  LoadedHd fake;
  fake->opens_by = GENERATE(fakes::kHdNull, fakes::kHdDefaultDevice, fakes::kHdDefaultPhantom);
  device::OpenHapticsDevice device(settings_of_fake());
  CHECK(next_sample(device).ready);
  CHECK(device.fault() == device::DeviceFault::none);
}

TEST_CASE("openhaptics: a named device is opened by that name alone") {
  LoadedHd fake;
  device::OpenHapticsSettings settings = settings_of_fake();
  settings.device = "Lab Touch";
  fake->opens_by = fakes::kHdLabTouch;
  { device::OpenHapticsDevice device(settings); }
  fake->opens_by = fakes::kHdNull | fakes::kHdDefaultDevice | fakes::kHdDefaultPhantom;
  CHECK_THROWS_WITH(device::OpenHapticsDevice(settings), holds_text("Lab Touch"));
}

TEST_CASE("openhaptics: the device describes itself") {
  LoadedHd fake;
  const device::DeviceInfo info = device::OpenHapticsDevice(settings_of_fake()).info();
  CHECK(info.name == "openhaptics");
  CHECK(info.model == "3D Systems Touch");
  CHECK(info.serial == "SN-4711");
  CHECK(info.firmware == "1.25");
  CHECK(info.library == "3.5.0");
  CHECK(info.max_force_n == 3.25);
  CHECK(info.continuous_force_n == 0.875);
  CHECK(info.max_stiffness_n_per_mm == Approx(0.4));
  CHECK(info.max_damping_n_s_per_mm == Approx(0.004));
  CHECK(info.max_rate_hz == 1000.0);
  CHECK_FALSE(info.simulated);
  REQUIRE(info.workspace);
  CHECK(info.workspace->min_mm == Vec3{-80.0, -60.0, -40.0});
  CHECK(info.workspace->max_mm == Vec3{80.0, 60.0, 30.0});
}

TEST_CASE("openhaptics: values that the library does not report get defaults") {
  LoadedHd fake;
  const auto info = [] { return device::OpenHapticsDevice(settings_of_fake()).info(); };
  fake->tells_damping = false;
  CHECK(info().max_damping_n_s_per_mm == 0.0);
  fake->tells_usable_workspace = false;
  CHECK(info().workspace.value().min_mm == Vec3{-210.0, -110.0, -85.0});
  CHECK(info().workspace.value().max_mm == Vec3{210.0, 205.0, 130.0});
  fake->tells_max_workspace = false;
  const device::Workspace usual = info().workspace.value();
  CHECK(usual.max_mm - usual.min_mm == Vec3{160.0, 120.0, 70.0});
}

TEST_CASE("openhaptics: position and buttons arrive as the library gives them") {
  LoadedHd fake;
  fake->hand.rest_at({10.0, -20.0, 30.5});
  fake->buttons = 2;
  device::OpenHapticsDevice device(settings_of_fake());
  const device::DeviceSample sample = next_sample(device);
  CHECK(sample.position_mm == Vec3{10.0, -20.0, 30.5});
  CHECK(sample.buttons == 2);
}

TEST_CASE("openhaptics: a wall carries the hand that pushes against it") {
  LoadedHd fake;
  fake->hand.position_mm.set({5.0, 3.0, 0.0});
  fake->hand.push_n.set({0.0, -0.7, 0.0});
  device::OpenHapticsDevice device(settings_of_fake());
  fakes::WallRun(device, fake.exports()).check_carries_hand();
}

TEST_CASE("openhaptics: without calibration the force stays zero, and the readiness says why") {
  LoadedHd fake;
  fake->calibrated = false;
  device::OpenHapticsDevice device(settings_of_fake());
  CHECK_FALSE(next_sample(device).ready);
  CHECK(device.readiness() == device::DeviceReadiness::needs_inkwell);
  const long begun = fake->frames;
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->frames > begun + 50; }));
  CHECK(fake->zero_forces_last >= 50);

  fake->in_inkwell = true;
  REQUIRE(eventually([&] { return device.readiness() == device::DeviceReadiness::ready; }));
  CHECK(next_sample(device).ready);
  CHECK(fake->calibration_updates == 1);
  CHECK(fake->last_style == fakes::kHdInkwell);
  CHECK(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
}

TEST_CASE("openhaptics: calibration prefers auto to inkwell to reset") {
  using device::DeviceReadiness;
  const auto [styles, need] = GENERATE(table<int, DeviceReadiness>(
      {{fakes::kHdEncoderReset | fakes::kHdAuto | fakes::kHdInkwell, DeviceReadiness::needs_homing},
       {fakes::kHdAuto | fakes::kHdInkwell, DeviceReadiness::needs_homing},
       {fakes::kHdEncoderReset | fakes::kHdInkwell, DeviceReadiness::needs_inkwell},
       {fakes::kHdEncoderReset, DeviceReadiness::needs_reset},
       {8, DeviceReadiness::needs_calibration}}));
  LoadedHd fake;
  fake->calibrated = false;
  fake->calibration_styles = styles;
  device::OpenHapticsDevice device(settings_of_fake());
  (void)next_sample(device);
  CHECK(device.readiness() == need);
  fake->in_inkwell = true;
  fake->has_news = true;
  const bool by_itself =
      need == DeviceReadiness::needs_homing || need == DeviceReadiness::needs_inkwell;
  REQUIRE(eventually([&] {
    return fake->frames > 300 && (device.readiness() == DeviceReadiness::ready) == by_itself;
  }));
  if (by_itself) {
    CHECK(fake->last_style ==
          (need == DeviceReadiness::needs_homing ? fakes::kHdAuto : fakes::kHdInkwell));
  } else {
    CHECK(fake->calibration_updates == 0);
  }
  CHECK(fake->misuses == 0);
}

TEST_CASE("openhaptics: an arm is reset where it is when a person says so, and never before") {
  LoadedHd fake;
  fake->calibration_styles = fakes::kHdEncoderReset;
  fake->calibrated = false;
  fake->encoder_error_mm.set({-170.0, 90.0, 40.0});
  fake->hand.rest_at({5.0, 3.0, 1.0});
  device::OpenHapticsDevice device(settings_of_fake());
  REQUIRE(eventually([&] { return fake->frames > 300; }));
  CHECK(fake->calibration_updates == 0);
  CHECK(device.readiness() == device::DeviceReadiness::needs_reset);

  const Vec3 reset_place = {12.0, -4.0, 9.0};
  fake->hand.rest_at(reset_place);
  device.calibrate();
  REQUIRE(eventually([&] { return device.readiness() == device::DeviceReadiness::ready; }));
  CHECK(fake->calibration_updates == 1);
  CHECK(fake->last_style == fakes::kHdEncoderReset);
  fake->hand.rest_at(reset_place + Vec3{1.0, 2.0, 3.0});
  const device::DeviceSample sample = next_sample(device);
  CHECK(sample.ready);
  CHECK(norm(sample.position_mm - Vec3{1.0, 2.0, 3.0}) < 1e-9);

  // Said again by mistake, it changes nothing.
  device.calibrate();
  (void)next_sample(device);
  CHECK(fake->calibration_updates == 1);
  CHECK(device.fault() == device::DeviceFault::none);
}

TEST_CASE("openhaptics: a calibration that fails is tried again, and is no fault") {
  LoadedHd fake;
  fake->calibrated = false;
  fake->in_inkwell = true;
  fake->failing_updates = 2;
  device::OpenHapticsDevice device(settings_of_fake());
  REQUIRE(eventually([&] { return device.readiness() == device::DeviceReadiness::ready; }));
  CHECK(fake->calibration_updates == 3);
  CHECK(device.fault() == device::DeviceFault::none);
}

TEST_CASE("openhaptics: a calibration update waits until forces are off") {
  LoadedHd fake;
  fake->calibration_styles = fakes::kHdAuto;
  fake->encoder_error_mm.set({0.5, 0.0, 0.0});
  fake->hand.rest_at({10.0, 0.0, 0.0});
  device::OpenHapticsDevice device(settings_of_fake());
  fakes::WallRun wall(device, fake.exports());
  REQUIRE(wall.run(50).end == device::ServoEnd::time_limit);
  fake->has_news = true;
  CHECK(wall.run(400).end == device::ServoEnd::time_limit);
  CHECK(fake->calibration_updates == 0);
  CHECK(device.readiness() == device::DeviceReadiness::ready);
  fake.exports().run_freely();
  REQUIRE(eventually([&] { return fake->calibration_updates == 1; }));
  CHECK(next_sample(device).position_mm == Vec3{10.0, 0.0, 0.0});
}

TEST_CASE("openhaptics: each of the library's errors becomes its own fault") {
  const auto [code, fault] = GENERATE(
      table<std::uint32_t, device::DeviceFault>({{0x200, device::DeviceFault::warm_motors},
                                                 {0x201, device::DeviceFault::limit_passed},
                                                 {0x202, device::DeviceFault::limit_passed},
                                                 {0x203, device::DeviceFault::limit_passed},
                                                 {0x204, device::DeviceFault::driver},
                                                 {0x300, device::DeviceFault::driver},
                                                 {0x302, device::DeviceFault::link_lost},
                                                 {0x304, device::DeviceFault::driver},
                                                 {0x400, device::DeviceFault::driver},
                                                 {0x402, device::DeviceFault::driver}}));
  LoadedHd fake;
  device::OpenHapticsDevice device(settings_of_fake());
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->force_n.get().y == 1.0; }));
  fake->next_error = code;
  REQUIRE(write_until(device, {0.0, 1.0, 0.0}, [&] { return fake->zero_forces_last > 10; }));
  CHECK(device.fault() == fault);
  device::DeviceSample sample;
  CHECK(device.read(sample) == device::DeviceStatus::fault);
  CHECK(device.write({0.0, 1.0, 0.0}) == device::DeviceStatus::fault);
}

TEST_CASE("openhaptics: a motor that gets too warm is a fault before the library says so") {
  LoadedHd fake;
  device::OpenHapticsDevice device(settings_of_fake());
  fake->warmth[4] = 0.94;
  REQUIRE(eventually([&] { return fake->frames > 300; }));
  CHECK(device.fault() == device::DeviceFault::none);
  fake->warmth[4] = 0.96;
  CHECK(eventually([&] { return device.fault() == device::DeviceFault::warm_motors; }));
}

TEST_CASE("openhaptics: a device that gives no temperature works without one") {
  LoadedHd fake;
  fake->tells_temperature = false;
  device::OpenHapticsDevice device(settings_of_fake());
  REQUIRE(eventually([&] { return fake->frames > 300; }));
  CHECK(device.fault() == device::DeviceFault::none);
}

TEST_CASE("openhaptics: a position that is not a number is a fault, and never reaches the servo") {
  LoadedHd fake;
  device::OpenHapticsDevice device(settings_of_fake());
  (void)next_sample(device);
  fake->hand.rest_at({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  REQUIRE(eventually([&] { return device.fault() == device::DeviceFault::bad_data; }));
  device::DeviceSample sample;
  CHECK(device.read(sample) == device::DeviceStatus::fault);
  CHECK(is_finite(sample.position_mm));
}

TEST_CASE("openhaptics: a device that is lost in the middle of a run ends it with a fault") {
  LoadedHd fake;
  fake->hand.push_n.set({0.0, -0.7, 0.0});
  device::OpenHapticsDevice device(settings_of_fake());
  fakes::WallRun wall(device, fake.exports());
  REQUIRE(wall.run(50).end == device::ServoEnd::time_limit);
  fake->lost = true;
  CHECK(wall.run(50).end == device::ServoEnd::fault);
  CHECK(device.fault() == device::DeviceFault::link_lost);
  CHECK(fake.exports().step(2));
  CHECK(fake->force_n.get() == Vec3{});
}

TEST_CASE("openhaptics: closing sends zeros, stops the scheduler first, and disables the device") {
  LoadedHd fake;
  {
    device::OpenHapticsDevice device(settings_of_fake());
    REQUIRE(write_until(device, {1.0, 0.0, 0.0}, [&] { return fake->force_n.get().x == 1.0; }));
  }
  CHECK(fake->zero_forces_last >= 5);
  CHECK(fake->misuses == 0);
  CHECK(fake.calls() ==
        "init force_on clamping_on ramping_on schedule start stop unschedule force_off "
        "disable_device ");
}

TEST_CASE("openhaptics: a callback that is still running at the stop is waited for") {
  LoadedHd fake;
  fake->lazy_stop = true;
  std::optional<device::OpenHapticsDevice> device(std::in_place, settings_of_fake());
  fake->hold_callback = true;
  REQUIRE(eventually([&] { return fake->callback_held.load(); }));
  std::thread closing([&] { device.reset(); });
  CHECK(eventually([&] { return fake.calls().ends_with("stop "); }));
  fake->hold_callback = false;
  closing.join();
  CHECK(fake.calls().ends_with("stop unschedule force_off disable_device "));
  CHECK(fake->misuses == 0);
}

TEST_CASE("openhaptics: a second device in the same program is refused until the first is closed") {
  LoadedHd fake;
  {
    device::OpenHapticsDevice device(settings_of_fake());
    CHECK_THROWS_AS(device::OpenHapticsDevice(settings_of_fake()), DeviceError);
    CHECK(next_sample(device).ready);
  }
  device::OpenHapticsDevice again(settings_of_fake());
  CHECK(next_sample(again).ready);
}

TEST_CASE("openhaptics: a rate that the scheduler refuses is reported, and the device closed") {
  LoadedHd fake;
  device::OpenHapticsSettings settings = settings_of_fake();
  settings.rate_hz = 1234;
  CHECK_THROWS_WITH(device::OpenHapticsDevice(settings), holds_text("openhaptics.rate_hz = 1234"));
  CHECK(fake.calls().ends_with("disable_device "));
  settings.rate_hz = 500;
  CHECK(device::OpenHapticsDevice(settings).info().max_rate_hz == 500.0);
}

device::DeviceListing listing_with(const std::filesystem::path& library) {
  device::DeviceSettings settings;
  settings.openhaptics.library = library;
  const std::vector<device::DeviceListing> listings =
      device::device_driver("openhaptics").list(settings);
  REQUIRE(listings.size() == 1);
  CHECK(listings[0].driver == "openhaptics");
  CHECK(listings[0].where == library.string());
  return listings[0];
}

TEST_CASE("the list of openhaptics names the connected device, and closes it") {
  fakes::LoadedHd fake;
  const device::DeviceListing listing = listing_with(TOUCHTRIAL_FAKE_HD);
  CHECK(listing.present);
  CHECK(listing.model == "3D Systems Touch");
  CHECK(listing.serial == "SN-4711");
  CHECK(listing.missing.empty());
  REQUIRE(listing.notes.size() == 1);
  CHECK_THAT(listing.notes[0], names("0.4 N/mm") && holds_text("0.004 N s/mm"));
  CHECK(fake.calls() == "init disable_device ");
}

TEST_CASE("openhaptics: a library with references that nothing resolves is used all the same") {
  CHECK_THAT(listing_with(TOUCHTRIAL_UNRESOLVED_HD).model, holds_text("Touch"));
}

TEST_CASE("openhaptics: what is missing is listed, and refused: device, library, function") {
  fakes::LoadedHd fake;
  fake->opens_by = 0;
  const auto [library, missing] =
      GENERATE(table<const char*, const char*>({{TOUCHTRIAL_FAKE_HD, "0x300"},
                                                {"/nowhere/libHD.so", "openhaptics.library"},
                                                {TOUCHTRIAL_PARTIAL_HD, "hdUnschedule"}}));
  const device::DeviceListing listing = listing_with(library);
  CHECK_FALSE(listing.present);
  REQUIRE(listing.missing.size() == 1);
  CHECK_THAT(listing.missing[0], holds_text(missing));
  device::OpenHapticsSettings settings{.library = library};
  CHECK_THROWS_AS(device::OpenHapticsDevice(settings), DeviceError);
  CHECK_THROWS_WITH(device::OpenHapticsDevice(settings), holds_text(missing));
}

TEST_CASE("openhaptics is opened through the registry by its name") {
  fakes::LoadedHd fake;
  device::DeviceSettings settings;
  settings.openhaptics.library = TOUCHTRIAL_FAKE_HD;
  CHECK(device::open_device("openhaptics", settings)->info().name == "openhaptics");
}

}  // namespace

}  // namespace touchtrial
