// The host of plug-ins, with the example that labs begin with, and with broken ones. The plug-ins
// are C99, built against the one header.
#include "device/drivers/plugin/plugin_device.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/drivers/plugin/lockstep_plugins.hpp"
#include "device/drivers/plugin/plugin_library.hpp"
#include "device/drivers/registry.hpp"
#include "device/fakes/loaded_fake.hpp"
#include "device/flat_wall.hpp"
#include "device/servo/placed_device.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <chrono>
#include <cmath>
#include <string>
#include <thread>

namespace touchtrial {
namespace {

device::PluginSettings example_with(const std::string& settings = "{}") {
  return {TOUCHTRIAL_EXAMPLE_PLUGIN, settings};
}

device::PluginSettings broken_by(const std::string& fault) {
  return {TOUCHTRIAL_BROKEN_PLUGIN, R"({"fault":")" + fault + R"("})"};
}

/// A plug-in's device in a test's time.
struct PluginRig {
  explicit PluginRig(const device::PluginSettings& settings)
      : library(settings.library), device(settings, clock.plugin_options()) {}

  device::DeviceSample sample() {
    device::DeviceSample newest;
    status = device.read(newest);
    return newest;
  }
  /// What the motors have after a tick in which the servo writes this force.
  Vec3 motors_after(Vec3 force_n) {
    status = device.write(force_n);
    clock.pass_ms(1);
    return library.observed_force_n().value();
  }

  LockstepClock clock;
  device::plugin::Library library;
  device::PluginDevice device;
  device::DeviceStatus status = device::DeviceStatus::ok;
};

TEST_CASE("a plug-in describes its device, and the driver's name stands before the model") {
  PluginRig rig(example_with());
  const device::DeviceInfo info = rig.device.info();
  CHECK(info.name == "plugin");
  CHECK(info.model == "example: simulated mass");
  CHECK(info.serial == "0001");
  CHECK(info.firmware == "1.0");
  CHECK(info.max_force_n == 3.0);
  CHECK(info.continuous_force_n == 1.0);
  CHECK(info.max_rate_hz == 1000.0);
  CHECK(info.max_stiffness_n_per_mm == 1.0);
  CHECK_FALSE(info.simulated);
  REQUIRE(info.workspace);
  CHECK(info.workspace->min_mm == Vec3{-60.0, -60.0, -60.0});
  CHECK(info.workspace->max_mm == Vec3{60.0, 60.0, 60.0});
  CHECK(info.workspace->shape == device::WorkspaceShape::ellipsoid);
}

TEST_CASE("a plug-in's readings and forces pass unchanged, once per exchange") {
  PluginRig rig(example_with());
  const Vec3 force_n{0.5, -1.0, 2.0};
  rig.clock.pass_ms(1);
  for (int i = 0; i < 20; ++i) CHECK(rig.motors_after(force_n) == force_n);
  const device::DeviceSample sample = rig.sample();
  CHECK(sample.sequence == 21);
  CHECK(sample.ready);
  CHECK(rig.device.readiness() == device::DeviceReadiness::ready);
  // 0.1 kg under these forces for 20 ms, with 4 N s/m; the spring hardly counts yet.
  CHECK(sample.velocity_mm_s.z == Approx(2000.0 / 4.0 * (1.0 - std::exp(-0.8))).epsilon(0.15));
  CHECK(sample.velocity_mm_s.y == Approx(-0.5 * sample.velocity_mm_s.z).epsilon(1e-6));
  CHECK(rig.status == device::DeviceStatus::ok);
}

TEST_CASE("a plug-in's mass rests where the wall and its spring hold each other") {
  PluginRig rig(example_with());
  LockstepHaptics ticking(rig.device, rig.clock);
  // The wall begins 1 mm above the place to which a spring of 0.1 N/mm pulls.
  device::PlacedDevice placed(ticking, {device::PlaneOrientation::horizontal, {0.0, 1.0, 0.0}});
  FlatWall wall;
  KeptSamples kept;
  const device::ServoReport report =
      device::run_servo_in_virtual_time(placed, wall, kept, {.limit_ticks = 2000});
  CHECK(report.end == device::ServoEnd::time_limit);
  REQUIRE(kept.samples.size() > 1999);
  // 0.4 N/mm z = 0.1 N/mm (1 mm - z)
  CHECK(kept.samples[1999].position_mm.z == Approx(-0.2).margin(1e-6));
  CHECK(kept.samples[1999].force_n.z == Approx(0.08).margin(1e-6));
}

TEST_CASE("a plug-in that needs no enabling gets its forces, and zeros, all the same") {
  const EnvironmentVariable broken("BROKEN_DEVICE", "no_enable");
  PluginRig rig({TOUCHTRIAL_BROKEN_PLUGIN, "{}"});
  rig.clock.pass_ms(1);
  CHECK(rig.motors_after({0.0, 1.0, 0.0}) == Vec3{0.0, 1.0, 0.0});
  rig.device.halt();
  CHECK(rig.motors_after({0.0, 1.0, 0.0}) == Vec3{});
}

TEST_CASE("an incomplete plug-in library is refused with the missing part") {
  const auto [how, places] =
      GENERATE(table<const char*, const char*>({{"nothing", "touchtrial_device_v1"},
                                                {"version", "2 1"},
                                                {"size", "24"},
                                                {"function", "force"},
                                                {"no_name", "1 32"},
                                                {"control_name", "1 32"},
                                                {"long_name", "1 32"}}));
  const EnvironmentVariable broken("BROKEN_DEVICE", how);
  CHECK_THROWS_AS(device::PluginDevice({TOUCHTRIAL_BROKEN_PLUGIN, "{}"}), DeviceError);
  CHECK_THROWS_WITH(device::PluginDevice({TOUCHTRIAL_BROKEN_PLUGIN, "{}"}),
                    names(TOUCHTRIAL_BROKEN_PLUGIN) && names(places) && names("plugin.library"));
}

TEST_CASE("a library without the entry, or none, is refused with the setting that names it") {
  CHECK_THROWS_WITH(device::PluginDevice({TOUCHTRIAL_FAKE_DHD, "{}"}),
                    names("touchtrial_device_v1"));
  CHECK_THROWS_WITH(device::PluginDevice({"/nowhere/driver.so", "{}"}),
                    names("/nowhere/driver.so"));
  CHECK_THROWS_WITH(device::open_device("plugin", {}), names("plugin.library"));
}

TEST_CASE("a device that does not open, or describes itself wrongly, is refused in words") {
  const auto [fault, places] =
      GENERATE(table<const char*, const char*>({{"opening", "broken-example"},
                                                {"description", "max_force_n 0 100"},
                                                {"no_serial", "serial"},
                                                {"inverted_workspace", "-10"},
                                                {"describe_writes_past", "broken-example"},
                                                {"describe_fails", "describe 17"}}));
  CHECK_THROWS_AS(device::PluginDevice(broken_by(fault)), DeviceError);
  CHECK_THROWS_WITH(device::PluginDevice(broken_by(fault)),
                    names("broken-example") && names(places));
  // Of a long text of the library, the beginning is printed.
  CHECK_THROWS_WITH(device::PluginDevice(broken_by("opening")), holds_text("xxxxxxxx"));
  CHECK_THROWS_WITH(device::PluginDevice(example_with(R"({"mass_kg":7})")),
                    names("example mass_kg 7 0.01 1"));
}

TEST_CASE("a plug-in's text without an end ends where its room does") {
  PluginRig rig(broken_by("endless_text"));
  CHECK(rig.device.info().model == "broken-example: " + std::string(64, 'm'));
}

TEST_CASE("what a plug-in reports or gets wrong latches as a fault, and the force is zero") {
  using device::DeviceFault;
  using device::plugin::PluginFault;
  const auto [name, fault, plugin_fault] = GENERATE(table<const char*, DeviceFault, PluginFault>(
      {{"staying", DeviceFault::link_lost, PluginFault::lost},
       {"warm", DeviceFault::warm_motors, PluginFault::warm_motors},
       {"unknown_code", DeviceFault::driver, PluginFault::failed},
       {"values", DeviceFault::bad_data, PluginFault::not_finite},
       {"huge", DeviceFault::bad_data, PluginFault::absurd},
       {"numbering", DeviceFault::bad_data, PluginFault::sequence_decreased},
       {"unknown_readiness", DeviceFault::bad_data, PluginFault::unknown_readiness},
       {"memory", DeviceFault::bad_data, PluginFault::wrote_past}}));
  PluginRig rig(broken_by(name));
  for (int i = 0; i < 50; ++i) (void)rig.motors_after({0.0, 1.0, 0.0});
  REQUIRE(rig.library.observed_force_n() == Vec3{0.0, 1.0, 0.0});
  REQUIRE(rig.device.fault() == DeviceFault::none);
  for (int i = 0; i < 300; ++i) (void)rig.motors_after({0.0, 1.0, 0.0});
  CHECK(rig.library.observed_force_n() == Vec3{});
  CHECK(rig.status == device::DeviceStatus::fault);
  CHECK(rig.device.fault() == fault);
  CHECK(rig.device.plugin_fault() == plugin_fault);
  const device::DeviceSample sample = rig.sample();
  CHECK(is_finite(sample.position_mm));
  CHECK(is_finite(sample.velocity_mm_s));
  rig.device.rearm();
  CHECK(rig.motors_after({0.0, 1.0, 0.0}) == Vec3{});
}

TEST_CASE("a plug-in that repeats a reading gives no new one, which the safety chain sees") {
  PluginRig rig(broken_by("standing"));
  rig.clock.pass_ms(20);
  CHECK(rig.sample().sequence == 1);
  LockstepHaptics ticking(rig.device, rig.clock);
  FlatWall wall;
  KeptSamples kept;
  const device::ServoReport report =
      device::run_servo_in_virtual_time(ticking, wall, kept, {.limit_ticks = 100});
  CHECK(report.fault == device::SafetyFault::stale_sample);
  CHECK(report.ticks < 15);
}

TEST_CASE("a plug-in whose call never returns gives no new reading, and closing does not wait") {
  device::PluginOptions options{.scheduling = {device::SchedulingPolicy::other, 0, false}};
  device::PluginSettings settings = broken_by("hanging");
  settings.library = TOUCHTRIAL_HANGING_PLUGIN;
  device::PluginDevice device(settings, std::move(options));
  device::DeviceSample sample;
  REQUIRE(fakes::eventually([&] {
    (void)device.read(sample);
    return sample.sequence == 300;
  }));
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(device.read(sample) == device::DeviceStatus::ok);
    CHECK(sample.sequence == 300);
  }
}

TEST_CASE("a plug-in that kills the process that loads it is found without loading it here") {
  const Bytes whole = read_file(TOUCHTRIAL_FAKE_HD);
  const TempFolder folder;
  device::DeviceSettings settings;
  settings.plugin.library = folder.path() / "cut.so";
  replace_file(settings.plugin.library, ByteView(whole).first(whole.size() / 4));
  const auto listing = device::device_driver("plugin").list(settings).at(0);
  CHECK_FALSE(listing.present);
  CHECK(listing.missing.size() == 1);
  CHECK_THROWS_AS(device::open_device("plugin", settings), DeviceError);
}

TEST_CASE("the list of plug-ins shows the one in the settings, or its problem") {
  device::DeviceSettings settings;
  const auto listed = [&] { return device::device_driver("plugin").list(settings).at(0); };
  CHECK_FALSE(listed().present);
  CHECK_THAT(listed().missing.at(0), names("plugin.library"));
  settings.plugin = example_with();
  CHECK(listed().present);
  CHECK(listed().model == "example: simulated mass");
  CHECK(listed().serial == "0001");
  CHECK(listed().where == TOUCHTRIAL_EXAMPLE_PLUGIN);
  CHECK(listed().missing.empty());
  settings.plugin = broken_by("opening");
  CHECK_FALSE(listed().present);
  CHECK_THAT(listed().missing.at(0), names("broken-example"));
}

TEST_CASE("a plug-in's settings are handed on as JSON, its library is relative to the file") {
  const device::DeviceSettings settings = device::parse_device_settings(
      R"({"plugin": {"library": "./arm.so", "settings": {"port": "/dev/ttyACM0", /* a */ "n": [1]},
          "limits": {"max_force_n": 2}, "placement": {"orientation": "vertical"}}})",
      "/lab", "devices.json");
  CHECK(settings.plugin.library == "/lab/./arm.so");
  CHECK(settings.plugin.settings == R"({"n":[1],"port":"/dev/ttyACM0"})");
  CHECK(settings.use_of("plugin").limits.max_force_n == 2.0);
  CHECK(settings.use_of("plugin").orientation == device::PlaneOrientation::vertical);
}

}  // namespace
}  // namespace touchtrial
