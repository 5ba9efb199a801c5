#include "device/drivers/inverse3/service_messages.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::device::inverse3 {
namespace {

using nlohmann::json;

/// This program's profile name in Haply Hub, which stores settings by profile.
constexpr const char* kProfile = "touchtrial";

json parsed_object(std::string_view text) {
  json value = json::parse(text.begin(), text.end(), nullptr, false);
  if (!value.is_object()) throw BadMessage("not a JSON object");
  return value;
}

/// \return the data of an answer that may be wrapped as {"ok": true, "data": ...}
json content_of(std::string_view text) {
  json value = parsed_object(text);
  const auto data = value.find("data");
  if (!value.contains("ok") || data == value.end() || !data->is_object()) return value;
  // Moved, because copying deeply nested values could exhaust the stack.
  json content = std::move(*data);
  return content;
}

const json& member_of(const json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end()) throw BadMessage(std::string("no ") + key);
  return *found;
}

/// \return null if there is none of this kind
const json* object_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_object() ? &*found : nullptr;
}

std::string text_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool bool_in(const json& object, const char* key) {
  const json& value = member_of(object, key);
  if (!value.is_boolean()) throw BadMessage(std::string(key) + " is not true or false");
  return value.get<bool>();
}

double number_in(const json& object, const char* key) {
  const json& value = member_of(object, key);
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw BadMessage(std::string(key) + " is not a finite number");
  }
  return value.get<double>();
}

std::optional<std::int64_t> whole_number_in(const json& object, const char* key) {
  const auto found = object.find(key);
  const bool is_integer = found != object.end() && found->is_number_integer();
  return is_integer ? std::optional(found->get<std::int64_t>()) : std::nullopt;
}

Vec3 vec3_in(const json& object, const char* key) {
  const json& value = member_of(object, key);
  return {number_in(value, "x"), number_in(value, "y"), number_in(value, "z")};
}

ArmStatus status_of(const json& status) {
  return {bool_in(status, "calibrated"), bool_in(status, "in_use"), bool_in(status, "power_supply"),
          bool_in(status, "ready"), bool_in(status, "started")};
}

/// \return the largest magnitude of the scalar and, if present, the vector of a damping
double damping_of(const json& damping) {
  double largest = std::abs(number_in(damping, "scalar"));
  if (!damping.contains("vector")) return largest;
  const Vec3 vector = vec3_in(damping, "vector");
  return std::max({largest, std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
}

bool has_unit_scale(const json& transform) {
  const json* const scale = object_in(transform, "scale");
  return scale == nullptr ||
         std::all_of(scale->begin(), scale->end(), [](const json& s) { return s == 1.0; });
}

std::string firmware_of(const json& config) {
  const json* const info = object_in(config, "device_info");
  if (info == nullptr) return "";
  const auto major = whole_number_in(*info, "major_version");
  const auto minor = whole_number_in(*info, "minor_version");
  return major && minor ? std::to_string(*major) + '.' + std::to_string(*minor) : "";
}

/// A boolean, or an object with the member "enabled".
bool is_enabled(const json& setting) {
  if (setting.is_boolean()) return setting.get<bool>();
  return bool_in(setting, "enabled");
}

DeviceConfig config_of(const json& config) {
  DeviceConfig result;
  if (const std::string type = text_in(config, "type"); !type.empty()) result.type = type;
  result.firmware = firmware_of(config);
  result.preset = text_in(config, "preset");
  if (const json* const filters = object_in(config, "filters")) {
    result.force_gate = number_in(member_of(*filters, "force_gate"), "gain");
    result.damping = damping_of(member_of(*filters, "damping"));
  }
  if (const json* const torque = object_in(config, "torque_scaling")) {
    result.torque_scaling = bool_in(*torque, "enabled");
  }
  if (const json* const gravity = object_in(config, "gravity_compensation")) {
    result.gravity_compensation =
        bool_in(*gravity, "enabled") ? number_in(*gravity, "scaling_factor") : 0.0;
  }
  result.handedness = text_in(config, "handedness");
  if (config.contains("home_return")) result.home_return = is_enabled(config.at("home_return"));
  if (const json* const basis = object_in(config, "basis")) {
    result.plain_frame = text_in(*basis, "permutation") == "XYZ";
  }
  if (const json* const mount = object_in(config, "mount")) {
    result.plain_frame = result.plain_frame && has_unit_scale(*mount);
  }
  return result;
}

DeviceReport device_of(const json& device) {
  DeviceReport result;
  result.id = text_in(device, "device_id");
  if (result.id.empty()) throw BadMessage("no device_id");
  const json& state = member_of(device, "state");
  result.position_m = vec3_in(state, "cursor_position");
  result.velocity_m_s = vec3_in(state, "cursor_velocity");
  if (state.contains("current_cursor_force")) {
    result.delivered_n = vec3_in(state, "current_cursor_force");
  }
  if (device.contains("status")) result.status = status_of(device.at("status"));
  if (const json* const config = object_in(device, "config")) result.config = config_of(*config);
  if (const json* const transform = object_in(state, "transform"); transform && result.config) {
    result.config->plain_frame = result.config->plain_frame && has_unit_scale(*transform);
  }
  return result;
}

std::uint32_t pressed_buttons(const json& state) {
  if (const json* const buttons = object_in(state, "buttons")) {
    std::uint32_t bits = 0;
    for (const auto& [key, bit] : {std::pair("a", 1U), std::pair("b", 2U), std::pair("c", 4U)}) {
      const auto found = buttons->find(key);
      if (found != buttons->end() && *found == true) bits |= bit;
    }
    return bits;
  }
  const auto button = state.find("button");
  return button != state.end() && *button == true ? 1U : 0U;
}

/// Malformed grips are ignored, because only their buttons are used.
std::uint32_t buttons_of(const json& report) {
  for (const char* const family : {"wireless_verse_grip", "verse_grip"}) {
    const auto grips = report.find(family);
    if (grips == report.end() || !grips->is_array() || grips->empty()) continue;
    if (!grips->front().is_object()) continue;
    if (const json* const state = object_in(grips->front(), "state"))
      return pressed_buttons(*state);
  }
  return 0;
}

json device_command(const ServiceVersion& version, const std::string& device, Vec3 force_n) {
  // Up to 3.4 a force's coordinates are named "values".
  const char* const key = version.has_filters() ? "vector" : "values";
  return {
      {"device_id", device},
      {"commands",
       {{"set_cursor_force", {{key, {{"x", force_n.x}, {"y", force_n.y}, {"z", force_n.z}}}}}}}};
}

std::string message_text(json message, json device) {
  message["inverse3"] = json::array();
  message["inverse3"].push_back(std::move(device));
  return message.dump();
}

}  // namespace

ServiceVersion parse_version(std::string_view text) {
  const json content = content_of(text);
  std::string version = text_in(content, "project_version");
  if (version.empty()) version = text_in(content, "git_tag");
  ServiceVersion result;
  const char* const end = version.data() + version.size();
  const auto major = std::from_chars(version.data(), end, result.major);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.' ||
      std::from_chars(major.ptr + 1, end, result.minor).ec != std::errc()) {
    throw BadMessage("no version");
  }
  return result;
}

ServiceReport parse_report(std::string_view text) {
  const json content = content_of(text);
  ServiceReport report;
  report.session_id = whole_number_in(content, "session_id");
  const auto devices = content.find("inverse3");
  if (devices != content.end()) {
    if (!devices->is_array()) throw BadMessage("inverse3 is not a list");
    for (const json& device : *devices) {
      if (!device.is_object()) throw BadMessage("a device is not an object");
      report.devices.push_back(device_of(device));
    }
  }
  report.buttons = buttons_of(content);
  return report;
}

bool parse_home_return(std::string_view text) {
  return is_enabled(content_of(text));
}

std::vector<std::string> parse_sessions(std::string_view text) {
  const json content = content_of(text);
  const json& sessions = member_of(content, "sessions");
  if (!sessions.is_array()) throw BadMessage("sessions is not a list");
  std::vector<std::string> names;
  for (const json& session : sessions) {
    const json* const profile = session.is_object() ? object_in(session, "profile") : nullptr;
    names.push_back(profile == nullptr ? std::string() : text_in(*profile, "name"));
  }
  return names;
}

ServiceEvent parse_event(std::string_view text) {
  const json content = parsed_object(text);
  ServiceEvent event;
  event.name = text_in(content, "name");
  if (event.name.empty()) throw BadMessage("an event without a name");
  event.category = text_in(content, "category");
  if (const json* const data = object_in(content, "data")) {
    event.safety_type = text_in(*data, "safety_type");
    event.device_id = text_in(*data, "device_id");
    event.session_id = whole_number_in(*data, "session_id");
  }
  return event;
}

std::string first_message(const ServiceVersion& version, const std::string& device) {
  json message = json::object();
  json device_message = device_command(version, device, {});
  if (version.has_filters()) {
    message["session"]["configure"]["profile"]["name"] = kProfile;
    device_message["configure"] = {
        {"preset", {{"preset", kCentredPreset}}},
        {"force_gate", {{"gain", 0.0}}},
        {"damping", {{"scalar", 0.0}, {"vector", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}}}}}};
  }
  return message_text(std::move(message), std::move(device_message));
}

std::string inventory_request(const ServiceVersion& version, const std::string& device) {
  json message = json::object();
  message["session"]["force_render_full_state"] = json::object();
  return message_text(std::move(message), device_command(version, device, {}));
}

std::string force_message(const ServiceVersion& version, const std::string& device, Vec3 force_n) {
  return message_text(json::object(), device_command(version, device, force_n));
}

}  // namespace touchtrial::device::inverse3
