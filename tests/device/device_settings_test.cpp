#include "device/device_settings.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

device::DeviceSettings parsed(const std::string& text) {
  return device::parse_device_settings(text, "/lab", "devices.json");
}

bool is_refused(const std::string& text, const std::string& places) {
  return refuses<StudyError>([&] { return parsed(text); }, places);
}

}  // namespace

TEST_CASE("device settings give every setting of the drivers") {
  const device::DeviceSettings settings = parsed(R"({
    "falcon": {"firmware": "fw.bin", "serial": "F7", "gravity_bias_n": [0, 0.5, -0.1],
               "led_order": [0, 2, 1], "motor_peak": 4000, "motor_continuous": 900,
               "motor_peak_s": 12.5},
    "openhaptics": {"library": "/opt/libHD.so", "device": "Left", "rate_hz": 2000},
    "dhd": {"library": "libdhd.so.3", "index": 1, "gravity_compensation": false,
            "effector_mass_kg": 0.2, "max_force_n": 12, "continuous_force_n": 4,
            "workspace_mm": [190, 190, 130]},
    "inverse3": {"host": "rig-2", "port": 8500, "events_port": 9000, "http_port": 8501, "device_id": "049D",
                 "max_force_n": 4},
    "replay": {"trace": "traces/one.csv"},
    "instruments": {"serial": {"port": "/dev/ttyUSB0"}}})");
  CHECK(settings.falcon.firmware == "/lab/fw.bin");
  CHECK(settings.falcon.serial == "F7");
  CHECK(settings.falcon.gravity_bias_n == Vec3{0.0, 0.5, -0.1});
  CHECK(settings.falcon.led_order == std::array<int, 3>{0, 2, 1});
  CHECK(settings.falcon.motor_peak == 4000);
  CHECK(settings.falcon.motor_continuous == 900);
  CHECK(settings.falcon.motor_peak_s == 12.5);
  CHECK(settings.openhaptics.library == "/opt/libHD.so");
  CHECK(settings.openhaptics.device == "Left");
  CHECK(settings.openhaptics.rate_hz == 2000);
  CHECK(settings.dhd.library == "libdhd.so.3");
  CHECK(settings.dhd.index == 1);
  CHECK_FALSE(settings.dhd.gravity_compensation);
  CHECK(settings.dhd.effector_mass_kg == 0.2);
  CHECK(settings.dhd.max_force_n == 12.0);
  CHECK(settings.dhd.continuous_force_n == 4.0);
  CHECK(settings.dhd.workspace_mm == Vec3{190.0, 190.0, 130.0});
  CHECK(settings.inverse3.host == "rig-2");
  CHECK(settings.inverse3.port == 8500);
  CHECK(settings.inverse3.events_port == 9000);
  CHECK(settings.inverse3.http_port == 8501);
  CHECK(settings.inverse3.device_id == "049D");
  CHECK(settings.inverse3.max_force_n == 4.0);
  CHECK(settings.replay.trace == "/lab/traces/one.csv");
  CHECK(settings.instruments.serial.port == "/dev/ttyUSB0");
}

TEST_CASE("a control character in a text is refused with its place") {
  // To the system the first of these names means the C library.
  CHECK(is_refused(R"({"openhaptics": {"library": "libc.so.6\u0000x"}})", "/openhaptics/library"));
  CHECK(parsed(R"({"falcon": {"serial": "Größe 7"}})").falcon.serial == "Größe 7");
}

TEST_CASE("a library is a name that the system looks up or a path from the file") {
  CHECK(parsed(R"({"dhd": {"library": "libdhd.so"}})").dhd.library == "libdhd.so");
  CHECK(parsed(R"({"dhd": {"library": "lib/libdhd.so"}})").dhd.library == "/lab/lib/libdhd.so");
  CHECK(is_refused(R"({"dhd": {"library": ""}})", "/dhd/library"));
}

TEST_CASE("limits and placement are kept for each driver") {
  const device::DeviceSettings settings = parsed(R"({
    "falcon": {"limits": {"max_force_n": 2, "continuous_force_n": 0.5, "max_slew_n_per_s": 300,
                          "max_speed_mm_s": 900},
               "placement": {"orientation": "vertical", "centre_mm": [1, -2, 3]}},
    "simulated": {"limits": {"max_force_n": 1}}})");
  const device::DeviceUse falcon = settings.use_of("falcon");
  CHECK(falcon.limits.max_force_n == 2.0);
  CHECK(falcon.limits.continuous_force_n == 0.5);
  CHECK(falcon.limits.max_slew_n_per_s == 300.0);
  CHECK(falcon.limits.max_speed_mm_s == 900.0);
  CHECK(falcon.orientation == device::PlaneOrientation::vertical);
  CHECK(falcon.centre_mm == Vec3{1.0, -2.0, 3.0});
  CHECK(settings.use_of("simulated").limits.max_force_n == 1.0);
  CHECK_FALSE(settings.use_of("dhd").limits.max_force_n.has_value());
  CHECK_FALSE(settings.use_of("dhd").orientation.has_value());
}

TEST_CASE("scales are one number for all axes, or one for each, and 1 otherwise") {
  const device::DeviceSettings settings = parsed(R"({
    "falcon": {"force_scale": 1.77, "length_scale": [1, 0.9, 1.1]}, "dhd": {}})");
  CHECK(settings.use_of("falcon").scale == device::DeviceScale{{1.77, 1.77, 1.77}, {1, 0.9, 1.1}});
  CHECK(settings.use_of("dhd").scale == device::DeviceScale{});
  CHECK(settings.use_of("inverse3").scale == device::DeviceScale{});
  CHECK(is_refused(R"({"dhd": {"force_scale": 0.1}})", "/dhd/force_scale"));
  CHECK(is_refused(R"({"dhd": {"length_scale": [1, 1, 6]}})", "/dhd/length_scale/2"));
  CHECK(is_refused(R"({"mouse": {"length_scale": 2}})", "/mouse/length_scale"));
}

TEST_CASE("a lab's limits make limits stricter and never looser") {
  const device::SafetyLimits usual;
  device::LabLimits lab{.max_force_n = 50.0, .max_speed_mm_s = 500.0};
  const device::SafetyLimits limits = device::stricter_of(usual, lab);
  CHECK(limits.max_force_n == usual.max_force_n);
  CHECK(limits.max_speed_mm_s == 500.0);
  CHECK(limits.max_slew_n_per_s == usual.max_slew_n_per_s);
  CHECK(limits.continuous_force_n == 0.0);
}

TEST_CASE("a lab's slew limit does not keep a force from being let go") {
  device::LabLimits lab{.max_slew_n_per_s = 1.0};
  const device::SafetyLimits limits = device::stricter_of({}, lab);
  CHECK(limits.max_slew_n_per_s == limits.max_force_n / device::kMaxReleaseS);
  CHECK(device::are_valid(limits));
}

TEST_CASE("a lab's continuous force holds if none is known or the known one is larger") {
  device::LabLimits lab{.continuous_force_n = 0.9};
  device::SafetyLimits known;
  CHECK(device::stricter_of(known, lab).continuous_force_n == 0.9);
  known.continuous_force_n = 0.5;
  CHECK(device::stricter_of(known, lab).continuous_force_n == 0.5);
  known.continuous_force_n = 2.0;
  CHECK(device::stricter_of(known, lab).continuous_force_n == 0.9);
}

TEST_CASE("device settings are refused with the place and a remedy") {
  CHECK(is_refused(R"({"falcn": {}})", "devices.json /falcn falcon"));
  CHECK(is_refused(R"({"dhd": {"max_force": 3}})", "/dhd/max_force max_force_n"));
  CHECK(is_refused(R"({"falcon": {"gravity_bias_n": [0.8, 0.8, 0]}})", "/falcon/gravity_bias_n"));
  CHECK(is_refused(R"({"falcon": {"led_order": [0, 1, 1]}})", "/falcon/led_order"));
  CHECK(is_refused(R"({"dhd": {"gravity_compensation": 1}})", "/dhd/gravity_compensation"));
  CHECK(is_refused(R"({"simulated": {"placement": {}}})", "/simulated/placement"));
  CHECK_THROWS_AS(device::read_device_settings("no/such/devices.json"), FileError);
}

TEST_CASE("the example settings are accepted and relative to their file") {
  const fs::path file = fs::path(TOUCHTRIAL_SOURCE_DIR) / "config" / "devices.json";
  const device::DeviceSettings settings = device::read_device_settings(file);
  CHECK(settings.falcon.firmware == file.parent_path() / "nvent_firmware.bin");
  CHECK(settings.use_of("dhd").limits.max_speed_mm_s == 1000.0);
}

TEST_CASE("settings come from the user's folder unless a file is named") {
  const TempFolder folder;
  const EnvironmentVariable own("XDG_CONFIG_HOME", folder.path().c_str());
  CHECK(device::default_device_settings_path() == folder.path() / "touchtrial" / "devices.json");
  CHECK(device::load_device_settings("").falcon.serial.empty());
  make_folder(folder.path() / "touchtrial");
  replace_file(device::default_device_settings_path(), R"({"falcon": {"serial": "usual"}})");
  replace_file(folder.path() / "mine.json", R"({"falcon": {"serial": "mine"}})");
  CHECK(device::load_device_settings("").falcon.serial == "usual");
  CHECK(device::load_device_settings(folder.path() / "mine.json").falcon.serial == "mine");
}

}  // namespace touchtrial
