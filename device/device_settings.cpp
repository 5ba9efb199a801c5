#include "device/device_settings.hpp"

#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "core/user_folders.hpp"
#include "device/drivers/registry.hpp"
#include "device/servo/scaled_device.hpp"

#include <algorithm>

namespace touchtrial::device {
namespace {

namespace fs = std::filesystem;

constexpr NumberRange kForceN{.low = 0.0, .high = 100.0, .open_low = true};
constexpr NumberRange kForceOrNoneN{.low = 0.0, .high = 100.0};
constexpr NumberRange kBiasN{.low = -FalconSettings::kMaxGravityBiasN,
                             .high = FalconSettings::kMaxGravityBiasN};
constexpr NumberRange kPlaceMm{.low = -1000.0, .high = 1000.0};
constexpr NumberRange kLengthMm{.low = 1.0, .high = 2000.0};
constexpr NumberRange kScale{.low = kMinScale, .high = kMaxScale};
constexpr NumberRange kMassKg{.low = 0.0, .high = 10.0};
constexpr std::int64_t kMaxMotorValue = 10'000;
constexpr NumberRange kPeakS{.low = 0.0, .high = 600.0, .open_low = true};
constexpr std::int64_t kMaxDevices = 64;
constexpr std::int64_t kFastestRateHz = 10'000;
constexpr std::int64_t kSlowestRateHz = 500;
/// Beside the drivers' names.
constexpr std::string_view kInstruments = "instruments";
constexpr std::int64_t kSlowestBaud = 9'600;
constexpr std::int64_t kFastestBaud = 1'000'000;
constexpr std::int64_t kWidestTrial = 4;
constexpr auto kMarkerFormats = std::to_array<Named<MarkerFormat>>(
    {{"byte", MarkerFormat::byte}, {"text", MarkerFormat::text}});
constexpr std::int64_t kLastPort = 65535;
constexpr auto kOrientations = std::to_array<Named<PlaneOrientation>>(
    {{"horizontal", PlaneOrientation::horizontal}, {"vertical", PlaneOrientation::vertical}});

Vec3 read_vec3(const JsonValue& place, const NumberRange& range) {
  const std::vector<JsonValue> items = place.items(3, 3);
  return {items[0].number(range), items[1].number(range), items[2].number(range)};
}

/// \return a text without zero bytes, which would end it early for the system and for vendors'
///   libraries
const std::string& plain_text(const JsonValue& place) {
  const std::string& text = place.text();
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (std::ranges::any_of(text, is_control)) {
    place.refuse("has a control character: " + in_quotes(text) + "; leave it out");
  }
  return text;
}

void read_text(const JsonObject& object, std::string_view key, std::string& text) {
  if (const auto member = object.find(key)) text = plain_text(*member);
}

/// Reads the path of a file; an empty text names no file.
void read_path(const JsonObject& object, std::string_view key, const fs::path& folder,
               fs::path& path) {
  const auto member = object.find(key);
  if (member && !plain_text(*member).empty()) path = folder / member->text();
}

/// Reads the name of a library: a path if it has a slash, else a name that the system looks up.
void read_library(const JsonObject& object, const fs::path& folder, fs::path& path) {
  const auto member = object.find("library");
  if (!member) return;
  const std::string& name = plain_text(*member);
  if (name.empty()) member->refuse("is empty; give the library's path, or leave the key out");
  path = name.find('/') == std::string::npos ? fs::path(name) : folder / name;
}

void read_limit(const JsonObject& object, std::string_view key, double highest,
                std::optional<double>& limit) {
  if (const auto member = object.find(key)) {
    limit = member->number({.low = 0.0, .high = highest, .open_low = true});
  }
}

LabLimits read_limits(const JsonValue& place) {
  const JsonObject object =
      place.object({"max_force_n", "continuous_force_n", "max_slew_n_per_s", "max_speed_mm_s"});
  const SafetyLimits usual;
  LabLimits limits;
  read_limit(object, "max_force_n", kForceN.high, limits.max_force_n);
  read_limit(object, "continuous_force_n", kForceN.high, limits.continuous_force_n);
  read_limit(object, "max_slew_n_per_s", usual.max_slew_n_per_s, limits.max_slew_n_per_s);
  read_limit(object, "max_speed_mm_s", usual.max_speed_mm_s, limits.max_speed_mm_s);
  return limits;
}

void read_placement(const JsonValue& place, DeviceUse& use) {
  const JsonObject object = place.object({"orientation", "centre_mm"});
  if (const auto member = object.find("orientation"))
    use.orientation = member->choice(kOrientations);
  if (const auto member = object.find("centre_mm")) use.centre_mm = read_vec3(*member, kPlaceMm);
}

/// Reads a number for all axes, or one for each.
void read_scale(const JsonObject& object, std::string_view key, Vec3& scale) {
  const auto member = object.find(key);
  if (!member) return;
  if (member->is_list()) {
    scale = read_vec3(*member, kScale);
    return;
  }
  const double all = member->number(kScale);
  scale = {all, all, all};
}

DeviceUse read_use(const JsonObject& object) {
  DeviceUse use;
  read_scale(object, "force_scale", use.scale.force);
  read_scale(object, "length_scale", use.scale.length);
  if (const auto member = object.find("limits")) use.limits = read_limits(*member);
  if (const auto member = object.find("placement")) read_placement(*member, use);
  return use;
}

std::array<int, 3> read_led_order(const JsonValue& place) {
  std::array<int, 3> order{};
  const std::vector<JsonValue> items = place.items(3, 3);
  for (std::size_t i = 0; i < 3; ++i) order[i] = static_cast<int>(items[i].integer(0, 2));
  if (order[0] == order[1] || order[1] == order[2] || order[0] == order[2]) {
    place.refuse("has a bit twice; give each of 0, 1 and 2 once");
  }
  return order;
}

Vec3 read_gravity_bias(const JsonValue& place) {
  const Vec3 bias_n = read_vec3(place, kBiasN);
  if (norm(bias_n) > kBiasN.high) {
    place.refuse("has a norm of " + number_text(norm(bias_n)) + " N, must be at most 1");
  }
  return bias_n;
}

DeviceUse read_falcon(const JsonValue& place, const fs::path& folder, DeviceSettings& settings) {
  const JsonObject object = place.object({"firmware", "serial", "gravity_bias_n", "led_order",
                                          "motor_peak", "motor_continuous", "motor_peak_s",
                                          "force_scale", "length_scale", "limits", "placement"});
  FalconSettings& falcon = settings.falcon;
  read_path(object, "firmware", folder, falcon.firmware);
  read_text(object, "serial", falcon.serial);
  if (const auto bias = object.find("gravity_bias_n")) {
    falcon.gravity_bias_n = read_gravity_bias(*bias);
  }
  if (const auto order = object.find("led_order")) falcon.led_order = read_led_order(*order);
  if (const auto value = object.find("motor_peak")) {
    falcon.motor_peak = static_cast<int>(value->integer(1, kMaxMotorValue));
  }
  if (const auto value = object.find("motor_continuous")) {
    falcon.motor_continuous = static_cast<int>(value->integer(1, kMaxMotorValue));
  }
  if (const auto time = object.find("motor_peak_s")) falcon.motor_peak_s = time->number(kPeakS);
  return read_use(object);
}

DeviceUse read_openhaptics(const JsonValue& place, const fs::path& folder,
                           DeviceSettings& settings) {
  const JsonObject object = place.object(
      {"library", "device", "rate_hz", "force_scale", "length_scale", "limits", "placement"});
  read_library(object, folder, settings.openhaptics.library);
  read_text(object, "device", settings.openhaptics.device);
  if (const auto rate = object.find("rate_hz")) {
    settings.openhaptics.rate_hz =
        static_cast<unsigned long>(rate->integer(kSlowestRateHz, kFastestRateHz));
  }
  return read_use(object);
}

DeviceUse read_dhd(const JsonValue& place, const fs::path& folder, DeviceSettings& settings) {
  const JsonObject object = place.object(
      {"library", "index", "gravity_compensation", "effector_mass_kg", "max_force_n",
       "continuous_force_n", "workspace_mm", "force_scale", "length_scale", "limits", "placement"});
  DhdSettings& dhd = settings.dhd;
  read_library(object, folder, dhd.library);
  if (const auto index = object.find("index")) {
    dhd.index = static_cast<int>(index->integer(0, kMaxDevices - 1));
  }
  if (const auto on = object.find("gravity_compensation")) dhd.gravity_compensation = on->truth();
  if (const auto mass = object.find("effector_mass_kg")) {
    dhd.effector_mass_kg = mass->number(kMassKg);
  }
  if (const auto force = object.find("max_force_n")) dhd.max_force_n = force->number(kForceN);
  if (const auto force = object.find("continuous_force_n")) {
    dhd.continuous_force_n = force->number(kForceOrNoneN);
  }
  if (const auto size = object.find("workspace_mm")) dhd.workspace_mm = read_vec3(*size, kLengthMm);
  return read_use(object);
}

DeviceUse read_plugin(const JsonValue& place, const fs::path& folder, DeviceSettings& settings) {
  const JsonObject object =
      place.object({"library", "settings", "force_scale", "length_scale", "limits", "placement"});
  read_library(object, folder, settings.plugin.library);
  if (const auto own = object.find("settings")) settings.plugin.settings = own->any_object();
  return read_use(object);
}

void read_port(const JsonObject& object, std::string_view key, int& port) {
  if (const auto member = object.find(key)) {
    port = static_cast<int>(member->integer(1, kLastPort));
  }
}

DeviceUse read_inverse3(const JsonValue& place, const fs::path&, DeviceSettings& settings) {
  const JsonObject object =
      place.object({"host", "port", "events_port", "http_port", "device_id", "max_force_n",
                    "force_scale", "length_scale", "limits", "placement"});
  Inverse3Settings& inverse3 = settings.inverse3;
  read_text(object, "host", inverse3.host);
  if (inverse3.host.empty()) {
    object.find("host")->refuse("is empty; give the host's name, or leave the key out");
  }
  read_port(object, "port", inverse3.port);
  read_port(object, "events_port", inverse3.events_port);
  read_port(object, "http_port", inverse3.http_port);
  read_text(object, "device_id", inverse3.device_id);
  if (const auto force = object.find("max_force_n")) inverse3.max_force_n = force->number(kForceN);
  return read_use(object);
}

DeviceUse read_replay(const JsonValue& place, const fs::path& folder, DeviceSettings& settings) {
  const JsonObject object = place.object({"trace", "limits"});
  read_path(object, "trace", folder, settings.replay.trace);
  return read_use(object);
}

MarkerLineSettings read_serial(const JsonValue& place) {
  const JsonObject object = place.object({"port", "baud", "format", "width", "reset_ms"});
  MarkerLineSettings serial;
  serial.port = plain_text(object.at("port"));
  if (serial.port.empty()) {
    object.at("port").refuse(
        "is empty; name the line, for instance /dev/ttyUSB0, or leave "
        "/instruments/serial out");
  }
  if (const auto format = object.find("format")) serial.format = format->choice(kMarkerFormats);
  if (const auto baud = object.find("baud")) {
    serial.baud = static_cast<int>(baud->integer(kSlowestBaud, kFastestBaud));
  }
  if (const auto width = object.find("width")) {
    serial.width = static_cast<int>(width->integer(0, kWidestTrial));
  }
  if (const auto reset = object.find("reset_ms")) {
    serial.reset_ms = reset->number({.low = 0.0, .high = 1000.0});
    if (serial.format == MarkerFormat::text && serial.reset_ms > 0.0) {
      reset->refuse("sets back codes sent as bytes; leave it out, or set the format to byte");
    }
  }
  return serial;
}

LabStreamingSettings read_lsl(const JsonValue& place, const fs::path& folder) {
  const JsonObject object = place.object({"library", "name"});
  LabStreamingSettings lsl;
  lsl.library = "liblsl.so";
  read_library(object, folder, lsl.library);
  read_text(object, "name", lsl.name);
  return lsl;
}

InstrumentSettings read_instruments(const JsonValue& place, const fs::path& folder) {
  const JsonObject object = place.object({"serial", "lsl"});
  InstrumentSettings instruments;
  if (const auto serial = object.find("serial")) instruments.serial = read_serial(*serial);
  if (const auto lsl = object.find("lsl")) instruments.lsl = read_lsl(*lsl, folder);
  return instruments;
}

/// Drivers with settings of their own; the others have only limits.
using ReadDriver = DeviceUse (*)(const JsonValue&, const fs::path&, DeviceSettings&);
constexpr auto kReaders = std::to_array<Named<ReadDriver>>({{"falcon", read_falcon},
                                                            {"openhaptics", read_openhaptics},
                                                            {"dhd", read_dhd},
                                                            {"plugin", read_plugin},
                                                            {"inverse3", read_inverse3},
                                                            {"replay", read_replay}});

DeviceUse read_driver(const std::string& driver, const JsonValue& place, const fs::path& folder,
                      DeviceSettings& settings) {
  const auto reader = std::ranges::find(kReaders, driver, &Named<ReadDriver>::name);
  if (reader == kReaders.end()) return read_use(place.object({"limits"}));
  return reader->value(place, folder, settings);
}

void tighten(double& limit, const std::optional<double>& lab) {
  if (lab) limit = std::min(limit, *lab);
}

/// \return the driver's section, which may have the name of one of its products
std::optional<JsonValue> section_of(const DeviceDriver& driver, const JsonObject& root) {
  std::optional<JsonValue> section;
  std::string_view taken;
  for (const std::string_view name : driver.names()) {
    const auto member = root.find(name);
    if (!member) continue;
    if (section) {
      member->refuse("is the driver of /" + std::string(taken) + " too; put its settings there");
    }
    section = member;
    taken = name;
  }
  return section;
}

}  // namespace

DeviceUse DeviceSettings::use_of(const std::string& driver) const {
  const auto found = uses.find(driver);
  return found == uses.end() ? DeviceUse{} : found->second;
}

SafetyLimits stricter_of(SafetyLimits limits, const LabLimits& lab) noexcept {
  tighten(limits.max_force_n, lab.max_force_n);
  tighten(limits.max_slew_n_per_s, lab.max_slew_n_per_s);
  limits.max_slew_n_per_s = std::max(limits.max_slew_n_per_s, limits.max_force_n / kLongestLetGoS);
  tighten(limits.max_speed_mm_s, lab.max_speed_mm_s);
  if (limits.continuous_force_n > 0.0) {
    tighten(limits.continuous_force_n, lab.continuous_force_n);
  } else {
    limits.continuous_force_n = lab.continuous_force_n.value_or(0.0);
  }
  return limits;
}

DeviceSettings parse_device_settings(std::string_view text, const fs::path& folder,
                                     const std::string& source) {
  std::vector<std::string_view> names = device_names();
  names.push_back(kInstruments);
  const JsonObject root = parse_strict_json(text, source).object(names);
  DeviceSettings settings;
  if (const auto member = root.find(kInstruments)) {
    settings.instruments = read_instruments(*member, folder);
  }
  for (const DeviceDriver& driver : device_drivers()) {
    if (const auto member = section_of(driver, root)) {
      settings.uses[driver.name] = read_driver(driver.name, *member, folder, settings);
    }
  }
  return settings;
}

DeviceSettings read_device_settings(const fs::path& file) {
  constexpr std::uintmax_t kLargest = 1U << 20U;
  const Bytes content = read_file(file, kLargest);
  return parse_device_settings(text_of(content), file.parent_path(), file.string());
}

fs::path default_device_settings_path() {
  const fs::path folder = user_config_folder();
  return folder.empty() ? folder : folder / "devices.json";
}

DeviceSettings device_settings_for(const fs::path& named) {
  if (!named.empty()) return read_device_settings(named);
  const fs::path usual = default_device_settings_path();
  return !usual.empty() && is_there(usual) ? read_device_settings(usual) : DeviceSettings{};
}

}  // namespace touchtrial::device
