/// \file Reads the device settings file.
#include "core/describe.hpp"
#include "core/files.hpp"
#include "device/device_settings.hpp"
#include "device/drivers/registry.hpp"
#include "device/servo/scaled_device.hpp"
#include "device/settings_schemas.hpp"

#include <algorithm>

namespace touchtrial::device {
namespace {

namespace fs = std::filesystem;

constexpr NumberRange kForceN{.low = 0.0, .high = 100.0, .open_low = true};
constexpr std::int64_t kMaxMotorValue = 10'000;
constexpr std::int64_t kMaxPort = 65535;
constexpr auto kMarkerFormats = std::to_array<Named<MarkerFormat>>(
    {{"byte", MarkerFormat::byte}, {"text", MarkerFormat::text}});
constexpr auto kOrientations = std::to_array<Named<PlaneOrientation>>(
    {{"horizontal", PlaneOrientation::horizontal}, {"vertical", PlaneOrientation::vertical}});

/// Refuses zero bytes, at which the system and vendors' libraries would truncate the text, and
/// other control characters.
void refuse_control_characters(const JsonValue& place) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (std::ranges::any_of(place.text(), is_control)) {
    place.refuse("has a control character: " + in_quotes(place.text()) + "; leave it out");
  }
}

constexpr std::string_view kPattern = R"(^[^\u0000-\u001f\u007f]*$)";
constexpr TextRule kPrintable{.check = refuse_control_characters, .pattern = kPattern};
constexpr TextRule kLibrary{
    .check =
        [](const JsonValue& place) {
          refuse_control_characters(place);
          if (!place.text().empty()) return;
          place.refuse("is empty; give the library's path, or leave the key out");
        },
    .min_length = 1,
    .pattern = kPattern,
    .description = "a name, or a path with a slash"};
constexpr TextRule kHost{.check =
                             [](const JsonValue& place) {
                               refuse_control_characters(place);
                               if (!place.text().empty()) return;
                               place.refuse("is empty; give the host's name, or leave the key out");
                             },
                         .min_length = 1,
                         .pattern = kPattern,
                         .description = "not empty"};
constexpr TextRule kLine{.check =
                             [](const JsonValue& place) {
                               refuse_control_characters(place);
                               if (!place.text().empty()) return;
                               place.refuse(
                                   "is empty; name the line, for instance /dev/ttyUSB0, or leave "
                                   "/instruments/serial out");
                             },
                         .min_length = 1,
                         .pattern = kPattern,
                         .description = "a path"};

/// The settings to fill, and the folder of relative paths.
struct ParsedFile {
  DeviceSettings& settings;
  const fs::path& folder;
};

/// Describes a file's path; an empty text names no file.
void describe_path(ObjectIo& io, std::string_view key, const fs::path& folder, fs::path& path,
                   const KeyInfo& key_info) {
  io.member(key, key_info, !path.empty(), [&](ValueIo& value) {
    std::string text;
    value.text(text, kPrintable);
    if (!text.empty()) path = folder / text;
  });
}

/// Describes a library: a path if it has a slash, else a name that the system looks up.
void describe_library(ObjectIo& io, const fs::path& folder, fs::path& path,
                      const KeyInfo& key_info) {
  io.member("library", key_info, !path.empty(), [&](ValueIo& value) {
    std::string name = path.string();
    value.text(name, kLibrary);
    path = name.find('/') == std::string::npos ? fs::path(name) : folder / name;
  });
}

void describe_falcon(ObjectIo& io, const ParsedFile& file) {
  FalconSettings& falcon = file.settings.falcon;
  constexpr double kMaxBiasN = FalconSettings::kMaxGravityBiasN;
  describe_path(io, "firmware", file.folder, falcon.firmware,
                {"the vendor's firmware image, needed unless the device already runs it"});
  io.text("serial", falcon.serial, kPrintable,
          {.meaning = "serial number of the Falcon to use", .default_text = "the only one"});
  io.member("gravity_bias_n",
            {.meaning = "force that supports the weight of the grip, in the device frame; not "
                        "subject to the force limits",
             .range = "three numbers from -1 to 1, norm at most 1"},
            true, [&](ValueIo& value) {
              value.axes(falcon.gravity_bias_n, {-kMaxBiasN, kMaxBiasN});
            });
  io.rule([&falcon](const JsonValue& place, const JsonObject& /*object*/) {
    if (norm(falcon.gravity_bias_n) <= kMaxBiasN) return;
    place.refuse_below(
        "/gravity_bias_n",
        "has a norm of " + number_text(norm(falcon.gravity_bias_n)) + " N, must be at most 1");
  });
  std::vector<int> order(falcon.led_order.begin(), falcon.led_order.end());
  io.list("led_order", order, {.min = 3, .max = 3, .unique = true},
          {.meaning = "bits of the red, green and blue light", .range = "0, 1, 2, each once"},
          [](ValueIo& value, int& bit) { value.integer(bit, 0, 2); });
  io.rule([&order](const JsonValue& place, const JsonObject& /*object*/) {
    if (order[0] != order[1] && order[1] != order[2] && order[0] != order[2]) return;
    place.refuse_below("/led_order", "has a bit twice; give each of 0, 1 and 2 once");
  });
  std::ranges::copy(order, falcon.led_order.begin());
  io.integer("motor_peak", falcon.motor_peak, 1, kMaxMotorValue,
             {"maximum motor value; 6,616 is 1 N m"});
  io.integer("motor_continuous", falcon.motor_continuous, 1, kMaxMotorValue,
             {"motor value that can be held indefinitely, a guess until measured; no limit if not "
              "below the maximum"});
  io.number("motor_peak_s", falcon.motor_peak_s, {.low = 0.0, .high = 600.0, .open_low = true},
            {"time for which a cold motor may have the maximum value"});
}

void describe_openhaptics(ObjectIo& io, const ParsedFile& file) {
  OpenHapticsSettings& openhaptics = file.settings.openhaptics;
  describe_library(io, file.folder, openhaptics.library,
                   {"the vendor's library; the system searches for a name without a slash"});
  io.text("device", openhaptics.device, kPrintable,
          {.meaning = "the device's name in the vendor's configuration",
           .default_text = "the vendor's default"});
  io.integer("rate_hz", openhaptics.rate_hz, 500, 10'000, {"rate of the vendor's scheduler"});
}

void describe_dhd(ObjectIo& io, const ParsedFile& file) {
  DhdSettings& dhd = file.settings.dhd;
  describe_library(io, file.folder, dhd.library,
                   {"the vendor's library, its folder or that of the kit; the default finds every "
                    "version of `libdrd.so` and `libdhd.so`"});
  io.integer("index", dhd.index, 0, 63, {"number of the device among those connected"});
  io.boolean("gravity_compensation", dhd.gravity_compensation,
             {"whether the maker's library compensates the weight of arms and effector while force "
              "is on"});
  io.number("effector_mass_kg", dhd.effector_mass_kg, {0.0, 10.0},
            {"mass of the effector; 0: the device's own value. At most 0.2 from that value, and "
             "limited by the model"});
  io.number("max_force_n", dhd.max_force_n, kForceN,
            {.meaning = "peak force, at most the model's", .default_text = "by model"});
  io.number("continuous_force_n", dhd.continuous_force_n, {0.0, 100.0},
            {.meaning = "force that the device can hold indefinitely; 0: unknown",
             .default_text = "by model"});
  io.optional("workspace_mm", dhd.workspace_mm,
              {.meaning = "width, height and depth of the ellipsoidal workspace",
               .default_text = "by model"},
              [](ValueIo& value, Vec3& size) {
                value.axes(size, {1.0, 2000.0});
              });
}

void describe_plugin(ObjectIo& io, const ParsedFile& file) {
  PluginSettings& plugin = file.settings.plugin;
  describe_library(
      io, file.folder, plugin.library,
      {"the library of the plug-in, required; the system searches for a name without a slash"});
  io.member("settings", {"passed to the plug-in unchanged"}, true, [&plugin](ValueIo& value) {
    value.custom(R"({"type": "object"})",
                 [&plugin](const JsonValue& place) { plugin.settings = place.object_text(); },
                 [&plugin] { return plugin.settings; });
  });
}

void describe_inverse3(ObjectIo& io, const ParsedFile& file) {
  Inverse3Settings& inverse3 = file.settings.inverse3;
  io.text("host", inverse3.host, kHost, {"the machine that runs Haply's Inverse service"});
  io.integer("port", inverse3.port, 1, kMaxPort, {"port of its simulation channel"});
  io.integer("events_port", inverse3.events_port, 1, kMaxPort, {"port of its events channel"});
  io.integer("http_port", inverse3.http_port, 1, kMaxPort,
             {"HTTP port, if the simulation channel has no HTTP (up to early 3.5 versions)"});
  io.text(
      "device_id", inverse3.device_id, kPrintable,
      {.meaning = "the device to use, as the service names it", .default_text = "the only one"});
  io.number("max_force_n", inverse3.max_force_n, kForceN,
            {"maximum force along each axis, not published by the maker"});
}

void describe_replay(ObjectIo& io, const ParsedFile& file) {
  describe_path(io, "trace", file.folder, file.settings.replay.trace,
                {"the recording: CSV with the columns time_s, x_mm, y_mm, z_mm"});
}

void describe_limits(ObjectIo& io, LabLimits& limits) {
  const SafetyLimits defaults;
  const auto up_to = [](double high) { return NumberRange{0.0, high, true}; };
  io.number("max_force_n", limits.max_force_n, kForceN, {"largest norm of a force"});
  io.number("continuous_force_n", limits.continuous_force_n, kForceN,
            {"force that can be held indefinitely; larger forces are reduced after some time"});
  io.number("max_slew_n_per_s", limits.max_slew_n_per_s, up_to(defaults.max_slew_n_per_s),
            {"maximum rate of change of the force"});
  io.number("max_speed_mm_s", limits.max_speed_mm_s, up_to(defaults.max_speed_mm_s),
            {"maximum speed of the hand; a higher speed is a fault"});
}

void describe_placement(ObjectIo& io, DeviceUse& use) {
  io.optional("orientation", use.orientation,
              {.meaning = "horizontal, like a table, or vertical, like a wall",
               .default_text = "`horizontal`"},
              [](ValueIo& value, PlaneOrientation& orientation) {
                value.choice(orientation, kOrientations);
              });
  io.optional("centre_mm", use.centre_mm,
              {.meaning = "position of a plane's centre relative to the centre of the workspace, "
                          "in the device frame: right, up, towards the person",
               .default_text = "the position with the largest margin"},
              [](ValueIo& value, Vec3& centre) {
                value.axes(centre, {-1000.0, 1000.0});
              });
}

/// Describes one number for all axes, or one for each.
void describe_scale(ValueIo& io, Vec3& scale) {
  constexpr NumberRange kRange{.low = kMinScale, .high = kMaxScale};
  const ValueIo::Form forms[] = {{[](const JsonValue& place) { return place.is_list(); },
                                  [&](ValueIo& value) { value.axes(scale, kRange); }},
                                 {{}, [&](ValueIo& value) {
                                    double factor = scale.x;
                                    value.number(factor, kRange);
                                    scale = {factor, factor, factor};
                                  }}};
  io.one_of(scale.x == scale.y && scale.y == scale.z ? 1 : 0, forms);
}

void describe_scales_and_placement(ObjectIo& io, DeviceUse& use) {
  io.member("force_scale",
            {"felt newtons per newton of the driver, for all axes or for each (right, up, towards "
             "the person): [force and length](devices/README.md#force-and-length). Force limits "
             "apply to felt newtons"},
            true, [&use](ValueIo& value) { describe_scale(value, use.scale.force); });
  io.member("length_scale", {"true millimetres per millimetre of the driver, likewise"}, true,
            [&use](ValueIo& value) { describe_scale(value, use.scale.length); });
  io.part("placement", use, {"position of planes in the workspace"}, describe_placement);
}

void describe_serial(ObjectIo& io, MarkerLineSettings& serial) {
  io.member("port",
            {.meaning = "serial line that receives event codes "
                        "([instruments](running-sessions.md#instruments-eeg-physiology-video))",
             .required = true},
            true, [&serial](ValueIo& value) {
              std::string port = serial.port.string();
              value.text(port, kLine);
              serial.port = port;
            });
  io.integer("baud", serial.baud, 9'600, 1'000'000, {"bits per second; one of the standard rates"});
  io.choice("format", serial.format, kMarkerFormats,
            {"`byte`: the code, then the trial's number, most significant byte first; `text`: for "
             "instance E10 T7 and a line feed"});
  io.integer(
      "width", serial.width, 0, 4,
      {"bytes of the trial's number after the code; with `text`, its minimum number of digits"});
  io.number("reset_ms", serial.reset_ms, {0.0, 1000.0},
            {"delay after which the byte 0 is sent; 0: never"});
  io.rule([&serial](const JsonValue& place, const JsonObject& /*object*/) {
    if (serial.format != MarkerFormat::text || serial.reset_ms == 0.0) return;
    place.refuse_below("/reset_ms",
                       "resets codes sent as bytes; leave it out, or set the format to byte");
  });
}

void describe_instruments(ObjectIo& io, const ParsedFile& file) {
  InstrumentSettings& instruments = file.settings.instruments;
  io.part("serial", instruments.serial, {"a serial line that receives a code for every event"},
          describe_serial);
  io.member("lsl",
            {"the Lab Streaming Layer: an outlet for markers and one for position and force; "
             "without this key there are none"},
            true, [&](ValueIo& value) {
              LabStreamingSettings& lsl = instruments.lsl;
              lsl.library = "liblsl.so";
              value.object([&](ObjectIo& keys) {
                describe_library(keys, file.folder, lsl.library, {"the user's library"});
                keys.text("name", lsl.name, kPrintable,
                          {"name of the streams: `NAME markers` and `NAME hand`"});
              });
            });
}

/// The section of a driver with specific settings; other drivers have only limits.
struct DriverSection {
  void (*describe)(ObjectIo& io, const ParsedFile& file);
  bool has_scales;
};
constexpr auto kDriverSections =
    std::to_array<Named<DriverSection>>({{"falcon", {describe_falcon, true}},
                                         {"openhaptics", {describe_openhaptics, true}},
                                         {"dhd", {describe_dhd, true}},
                                         {"plugin", {describe_plugin, true}},
                                         {"inverse3", {describe_inverse3, true}},
                                         {"replay", {describe_replay, false}}});

/// Describes a driver's section, whose key is the name of the driver or of one of its products.
void describe_driver(ObjectIo& io, const DeviceDriver& driver, const ParsedFile& file) {
  std::vector<std::string_view> names = driver.names();
  io.rule([&names](const JsonValue& /*place*/, const JsonObject& file_object) {
    std::string_view first_name;
    for (const std::string_view name : names) {
      const auto section = file_object.find(name);
      if (section && !first_name.empty()) {
        section->refuse("names the same driver as /" + std::string(first_name) +
                        "; put its settings there");
      }
      if (section) first_name = name;
    }
  });
  std::erase(names, std::string_view(driver.name));
  std::optional<DeviceUse> section_use;
  io.optional(driver.name, section_use, {.meaning = driver.what, .aliases = names},
              [&](ValueIo& value, DeviceUse& use) {
                value.object([&](ObjectIo& keys) {
                  const auto* const section =
                      std::ranges::find(kDriverSections, driver.name, &Named<DriverSection>::name);
                  const bool has_section = section != kDriverSections.end();
                  if (has_section) section->value.describe(keys, file);
                  if (has_section && section->value.has_scales)
                    describe_scales_and_placement(keys, use);
                  keys.part(
                      "limits", use.limits,
                      {"limits that apply in addition to those of the study and of the device"},
                      describe_limits);
                });
              });
  if (section_use) file.settings.uses[driver.name] = *section_use;
}

void describe(ObjectIo& io, const ParsedFile& file) {
  io.member("instruments", {"instruments that record during a session and receive its events"},
            true, [&](ValueIo& value) {
              value.object([&](ObjectIo& keys) { describe_instruments(keys, file); });
            });
  for (const DeviceDriver& driver : device_drivers()) describe_driver(io, driver, file);
}

}  // namespace

DeviceSettings parse_device_settings(std::string_view text, const fs::path& folder,
                                     const std::string& source) {
  DeviceSettings settings;
  read_settings(parse_strict_json(text, source), [&](ObjectIo& io) {
    describe(io, {settings, folder});
  });
  return settings;
}

DeviceSettings read_device_settings(const fs::path& file) {
  constexpr std::uintmax_t kMaxFileBytes = 1U << 20U;
  const Bytes content = read_file(file, kMaxFileBytes);
  return parse_device_settings(text_of(content), file.parent_path(), file.string());
}

std::string device_settings_schema() {
  DeviceSettings defaults;
  const fs::path folder;
  return annotated_schema(
      "Touchtrial device settings",
      "The settings of a lab's devices, one section for each driver, by its name or that of a "
      "product. Every key has a default. Paths are relative to the file.",
      R"([{"falcon": {"firmware": "nvent_firmware.bin"}},
          {"openhaptics": {"library": "/opt/OpenHaptics/lib/libHD.so",
                           "placement": {"orientation": "vertical"}}}])",
      [&](ObjectIo& io) {
        describe(io, {defaults, folder});
      });
}

}  // namespace touchtrial::device
