/// \file The settings file of a lab's devices: every key, as it is read.
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
constexpr std::int64_t kLastPort = 65535;
constexpr auto kMarkerFormats = std::to_array<Named<MarkerFormat>>(
    {{"byte", MarkerFormat::byte}, {"text", MarkerFormat::text}});
constexpr auto kOrientations = std::to_array<Named<PlaneOrientation>>(
    {{"horizontal", PlaneOrientation::horizontal}, {"vertical", PlaneOrientation::vertical}});

/// Refuses zero bytes, which would end a text early for the system and for vendors' libraries, and
/// other control characters.
void check_plain(const JsonValue& place) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (std::ranges::any_of(place.text(), is_control)) {
    place.refuse("has a control character: " + in_quotes(place.text()) + "; leave it out");
  }
}

constexpr std::string_view kPattern = R"(^[^\u0000-\u001f\u007f]*$)";
constexpr TextRule kPlain{.check = check_plain, .pattern = kPattern};
constexpr TextRule kLibrary{
    .check =
        [](const JsonValue& place) {
          check_plain(place);
          if (!place.text().empty()) return;
          place.refuse("is empty; give the library's path, or leave the key out");
        },
    .min_length = 1,
    .pattern = kPattern,
    .in_words = "a name, or a path with a slash"};
constexpr TextRule kHost{.check =
                             [](const JsonValue& place) {
                               check_plain(place);
                               if (!place.text().empty()) return;
                               place.refuse("is empty; give the host's name, or leave the key out");
                             },
                         .min_length = 1,
                         .pattern = kPattern,
                         .in_words = "not empty"};
constexpr TextRule kLine{.check =
                             [](const JsonValue& place) {
                               check_plain(place);
                               if (!place.text().empty()) return;
                               place.refuse(
                                   "is empty; name the line, for instance /dev/ttyUSB0, or leave "
                                   "/instruments/serial out");
                             },
                         .min_length = 1,
                         .pattern = kPattern,
                         .in_words = "a path"};

/// The settings that are read, and where relative paths start.
struct File {
  DeviceSettings& settings;
  const fs::path& folder;
};

/// The path of a file; an empty text names no file.
void describe_path(ObjectIo& io, std::string_view key, const fs::path& folder, fs::path& path,
                   const About& about) {
  io.member(key, about, !path.empty(), [&](ValueIo& value) {
    std::string text;
    value.text(text, kPlain);
    if (!text.empty()) path = folder / text;
  });
}

/// The name of a library: a path if it has a slash, else a name that the system looks up.
void describe_library(ObjectIo& io, const fs::path& folder, fs::path& path, const About& about) {
  io.member("library", about, !path.empty(), [&](ValueIo& value) {
    std::string name = path.string();
    value.text(name, kLibrary);
    path = name.find('/') == std::string::npos ? fs::path(name) : folder / name;
  });
}

void describe_falcon(ObjectIo& io, const File& file) {
  FalconSettings& falcon = file.settings.falcon;
  constexpr double kMaxBiasN = FalconSettings::kMaxGravityBiasN;
  describe_path(io, "firmware", file.folder, falcon.firmware,
                {"the vendor's firmware image, needed unless the device already runs it"});
  io.text("serial", falcon.serial, kPlain,
          {.meaning = "serial number of the Falcon to use", .otherwise = "the only one"});
  io.member("gravity_bias_n",
            {.meaning = "force that carries the grip, in the device frame, beside the limits of "
                        "force",
             .range = "three from -1 to 1, norm at most 1"},
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
  io.list("led_order", order, {.fewest = 3, .most = 3, .unique = true},
          {.meaning = "bits of the red, green and blue light", .range = "0, 1, 2, each once"},
          [](ValueIo& value, int& bit) { value.integer(bit, 0, 2); });
  io.rule([&order](const JsonValue& place, const JsonObject& /*object*/) {
    if (order[0] != order[1] && order[1] != order[2] && order[0] != order[2]) return;
    place.refuse_below("/led_order", "has a bit twice; give each of 0, 1 and 2 once");
  });
  std::ranges::copy(order, falcon.led_order.begin());
  io.integer("motor_peak", falcon.motor_peak, 1, kMaxMotorValue,
             {"greatest motor value, of 6,616 for 1 N m"});
  io.integer("motor_continuous", falcon.motor_continuous, 1, kMaxMotorValue,
             {"motor value without a time limit, a guess until it is measured; none if not below "
              "the greatest"});
  io.number("motor_peak_s", falcon.motor_peak_s, {.low = 0.0, .high = 600.0, .open_low = true},
            {"how long a cold motor may have the greatest value"});
}

void describe_openhaptics(ObjectIo& io, const File& file) {
  OpenHapticsSettings& touch = file.settings.openhaptics;
  describe_library(io, file.folder, touch.library,
                   {"the vendor's library; the system searches for a name without a slash"});
  io.text("device", touch.device, kPlain,
          {.meaning = "the device's name in the vendor's configuration",
           .otherwise = "the vendor's default"});
  io.integer("rate_hz", touch.rate_hz, 500, 10'000, {"rate of the vendor's scheduler"});
}

void describe_dhd(ObjectIo& io, const File& file) {
  DhdSettings& dhd = file.settings.dhd;
  describe_library(io, file.folder, dhd.library,
                   {"the vendor's library, its folder or that of the kit; the default finds every "
                    "version of `libdrd.so` and `libdhd.so`"});
  io.integer("index", dhd.index, 0, 63, {"number of the device among those connected"});
  io.truth("gravity_compensation", dhd.gravity_compensation,
           {"whether the maker's library carries the weight of arms and effector while force is "
            "on"});
  io.number("effector_mass_kg", dhd.effector_mass_kg, {0.0, 10.0},
            {"mass of the effector; 0: the device's own value, from which it may differ by 0.2; "
             "it weighs no more than the model can"});
  io.number("max_force_n", dhd.max_force_n, kForceN,
            {.meaning = "peak force, at most the model's", .otherwise = "by model"});
  io.number("continuous_force_n", dhd.continuous_force_n, {0.0, 100.0},
            {.meaning = "force that the device can hold for any time; 0: not known",
             .otherwise = "by model"});
  io.optional("workspace_mm", dhd.workspace_mm,
              {.meaning = "width, height and depth of the ellipsoid that the device reaches",
               .otherwise = "by model"},
              [](ValueIo& value, Vec3& size) {
                value.axes(size, {1.0, 2000.0});
              });
}

void describe_plugin(ObjectIo& io, const File& file) {
  PluginSettings& plugin = file.settings.plugin;
  describe_library(io, file.folder, plugin.library,
                   {"the plug-in, without which it cannot be used; the system searches for a name "
                    "without a slash"});
  io.member("settings", {"handed to the plug-in as it stands"}, true, [&plugin](ValueIo& value) {
    value.own(R"({"type": "object"})",
              [&plugin](const JsonValue& place) { plugin.settings = place.any_object(); },
              [&plugin] { return plugin.settings; });
  });
}

void describe_inverse3(ObjectIo& io, const File& file) {
  Inverse3Settings& inverse3 = file.settings.inverse3;
  io.text("host", inverse3.host, kHost, {"the machine that runs Haply's Inverse service"});
  io.integer("port", inverse3.port, 1, kLastPort, {"port of its simulation channel"});
  io.integer("events_port", inverse3.events_port, 1, kLastPort, {"port of its events channel"});
  io.integer("http_port", inverse3.http_port, 1, kLastPort,
             {"port of HTTP where that of the simulation channel has none, as before later "
              "versions 3.5"});
  io.text(
      "device_id", inverse3.device_id, kPlain,
      {.meaning = "the device to use, by the service's name for it", .otherwise = "the only one"});
  io.number("max_force_n", inverse3.max_force_n, kForceN,
            {"largest force along each axis, which the maker does not publish"});
}

void describe_replay(ObjectIo& io, const File& file) {
  describe_path(io, "trace", file.folder, file.settings.replay.trace,
                {"the recording: CSV with the columns time_s, x_mm, y_mm, z_mm"});
}

void describe_limits(ObjectIo& io, LabLimits& limits) {
  const SafetyLimits usual;
  const auto up_to = [](double high) { return NumberRange{0.0, high, true}; };
  io.number("max_force_n", limits.max_force_n, kForceN, {"largest norm of a force"});
  io.number("continuous_force_n", limits.continuous_force_n, kForceN,
            {"force that may last for any time; a larger one is reduced after a while"});
  io.number("max_slew_n_per_s", limits.max_slew_n_per_s, up_to(usual.max_slew_n_per_s),
            {"fastest change of a force"});
  io.number("max_speed_mm_s", limits.max_speed_mm_s, up_to(usual.max_speed_mm_s),
            {"largest speed of the hand; a higher one is a fault"});
}

void describe_placement(ObjectIo& io, DeviceUse& use) {
  io.optional(
      "orientation", use.orientation,
      {.meaning = "like a table before the person, or like a wall", .otherwise = "`horizontal`"},
      [](ValueIo& value, PlaneOrientation& one) { value.choice(one, kOrientations); });
  io.optional("centre_mm", use.centre_mm,
              {.meaning = "the place of a plane's middle in the device frame: to the right, up, "
                          "towards the person, from the middle of the workspace",
               .otherwise = "the place with the largest margin"},
              [](ValueIo& value, Vec3& centre) {
                value.axes(centre, {-1000.0, 1000.0});
              });
}

/// A number for all axes, or one for each.
void describe_scale(ValueIo& io, Vec3& scale) {
  constexpr NumberRange kScale{.low = kMinScale, .high = kMaxScale};
  const ValueIo::Form forms[] = {{[](const JsonValue& place) { return place.is_list(); },
                                  [&](ValueIo& value) { value.axes(scale, kScale); }},
                                 {{}, [&](ValueIo& value) {
                                    double all = scale.x;
                                    value.number(all, kScale);
                                    scale = {all, all, all};
                                  }}};
  io.either(scale.x == scale.y && scale.y == scale.z ? 1 : 0, forms);
}

void describe_scales_and_placement(ObjectIo& io, DeviceUse& use) {
  io.member("force_scale",
            {"felt newtons for one of the driver's, for all axes or for each (to the right, up, "
             "towards the person): [force and length](devices/README.md#force-and-length). Limits "
             "of force hold as felt"},
            true, [&use](ValueIo& value) { describe_scale(value, use.scale.force); });
  io.member("length_scale", {"true millimetres for one of the driver's, likewise"}, true,
            [&use](ValueIo& value) { describe_scale(value, use.scale.length); });
  io.part("placement", use, {"where planes lie in the workspace"}, describe_placement);
}

void describe_serial(ObjectIo& io, MarkerLineSettings& serial) {
  io.member("port",
            {.meaning = "serial line that gets event codes "
                        "([instruments](running-sessions.md#instruments-eeg-physiology-video))",
             .required = true},
            true, [&serial](ValueIo& value) {
              std::string port = serial.port.string();
              value.text(port, kLine);
              serial.port = port;
            });
  io.integer("baud", serial.baud, 9'600, 1'000'000, {"bits per second, of the usual rates"});
  io.choice("format", serial.format, kMarkerFormats,
            {"the code and bytes of the trial's number, most significant first; or for instance "
             "E10 T7 and a line feed"});
  io.integer("width", serial.width, 0, 4,
             {"bytes of the trial's number after the code; digits that it has at least"});
  io.number("reset_ms", serial.reset_ms, {0.0, 1000.0},
            {"after which the byte 0 follows; 0: never"});
  io.rule([&serial](const JsonValue& place, const JsonObject& /*object*/) {
    if (serial.format != MarkerFormat::text || serial.reset_ms == 0.0) return;
    place.refuse_below("/reset_ms",
                       "sets back codes sent as bytes; leave it out, or set the format to byte");
  });
}

void describe_instruments(ObjectIo& io, const File& file) {
  InstrumentSettings& instruments = file.settings.instruments;
  io.part("serial", instruments.serial, {"a serial line that gets a code for every event"},
          describe_serial);
  io.member("lsl",
            {"the Lab Streaming Layer: an outlet of markers and one of position and force; without "
             "it there are none"},
            true, [&](ValueIo& value) {
              LabStreamingSettings& lsl = instruments.lsl;
              lsl.library = "liblsl.so";
              value.object([&](ObjectIo& keys) {
                describe_library(keys, file.folder, lsl.library, {"the user's library"});
                keys.text("name", lsl.name, kPlain,
                          {"name of the streams: `NAME markers` and `NAME hand`"});
              });
            });
}

/// Drivers with settings of their own; the others have only limits.
struct OwnSettings {
  void (*describe)(ObjectIo& io, const File& file);
  bool has_scales;
};
constexpr auto kOwnSettings =
    std::to_array<Named<OwnSettings>>({{"falcon", {describe_falcon, true}},
                                       {"openhaptics", {describe_openhaptics, true}},
                                       {"dhd", {describe_dhd, true}},
                                       {"plugin", {describe_plugin, true}},
                                       {"inverse3", {describe_inverse3, true}},
                                       {"replay", {describe_replay, false}}});

/// The driver's section, which may have the name of one of its products.
void describe_driver(ObjectIo& io, const DeviceDriver& driver, const File& file) {
  std::vector<std::string_view> names = driver.names();
  io.rule([&names](const JsonValue& /*place*/, const JsonObject& file_object) {
    std::string_view taken;
    for (const std::string_view name : names) {
      const auto section = file_object.find(name);
      if (section && !taken.empty()) {
        section->refuse("is the driver of /" + std::string(taken) + " too; put its settings there");
      }
      if (section) taken = name;
    }
  });
  std::erase(names, std::string_view(driver.name));
  std::optional<DeviceUse> read;
  io.optional(driver.name, read, {.meaning = driver.what, .also = names},
              [&](ValueIo& value, DeviceUse& use) {
                value.object([&](ObjectIo& keys) {
                  const auto* const own =
                      std::ranges::find(kOwnSettings, driver.name, &Named<OwnSettings>::name);
                  const bool has_own = own != kOwnSettings.end();
                  if (has_own) own->value.describe(keys, file);
                  if (has_own && own->value.has_scales) describe_scales_and_placement(keys, use);
                  keys.part("limits", use.limits,
                            {"limits that make those of the study and of the device stricter"},
                            describe_limits);
                });
              });
  if (read) file.settings.uses[driver.name] = *read;
}

void describe(ObjectIo& io, const File& file) {
  io.member("instruments", {"what records beside a session and is told of its events"}, true,
            [&](ValueIo& value) {
              value.object([&](ObjectIo& keys) { describe_instruments(keys, file); });
            });
  for (const DeviceDriver& driver : device_drivers()) describe_driver(io, driver, file);
}

}  // namespace

DeviceSettings parse_device_settings(std::string_view text, const fs::path& folder,
                                     const std::string& source) {
  DeviceSettings settings;
  read_described(parse_strict_json(text, source), [&](ObjectIo& io) {
    describe(io, {settings, folder});
  });
  return settings;
}

DeviceSettings read_device_settings(const fs::path& file) {
  constexpr std::uintmax_t kLargest = 1U << 20U;
  const Bytes content = read_file(file, kLargest);
  return parse_device_settings(text_of(content), file.parent_path(), file.string());
}

std::string device_settings_schema() {
  DeviceSettings usual;
  const fs::path folder;
  return annotated_schema(
      "Touchtrial device settings",
      "The settings of a lab's devices, one section for each driver, by its name or that of a "
      "product. Every key has a default. Paths are relative to the file.",
      R"([{"falcon": {"firmware": "nvent_firmware.bin"}},
          {"openhaptics": {"library": "/opt/OpenHaptics/lib/libHD.so",
                           "placement": {"orientation": "vertical"}}}])",
      [&](ObjectIo& io) {
        describe(io, {usual, folder});
      });
}

}  // namespace touchtrial::device
