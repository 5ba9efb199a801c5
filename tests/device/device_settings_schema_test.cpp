// Compares the JSON Schema of device settings with their reader: tries every statement of the
// schema on the reader, and looks up the reader's keys in the schema.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/device_settings.hpp"
#include "device/known_keys.hpp"
#include "device/registry.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

const json& schema() {
  static const json kSchema = json::parse(text_of(read_file(
      std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config/schema/devices.schema.json")));
  return kSchema;
}

json resolved(const json& node) {
  if (!node.contains("$ref")) return node;
  return schema().at(Pointer(node.at("$ref").get<std::string>().substr(1)));
}

/// One leaf of the schema and its place in a settings file.
struct Leaf {
  Pointer place;
  json rule;
};

struct ObjectPlace {
  Pointer place;
  json rule;
};

void collect(const json& node, const Pointer& place, std::vector<Leaf>& leaves,
             std::vector<ObjectPlace>& objects) {
  const json rule = resolved(node);
  if (rule.contains("anyOf")) {
    for (const json& one : rule.at("anyOf")) leaves.push_back({place, resolved(one)});
    return;
  }
  // Of an object that may have any key, the reader knows none.
  if (rule.at("type") != "object" || rule.at("additionalProperties") == true) {
    leaves.push_back({place, rule});
    return;
  }
  CHECK(rule.at("additionalProperties") == false);
  objects.push_back({place, rule});
  for (const auto& [key, property] : rule.at("properties").items()) {
    // Another name of a section.
    if (property.value("$ref", "").starts_with("#/properties/")) continue;
    collect(property, place / key, leaves, objects);
  }
}

/// A number, or a list of three.
bool is_scale(const Leaf& leaf) {
  return leaf.place.back() == "force_scale" || leaf.place.back() == "length_scale";
}

std::vector<Leaf> all_leaves() {
  std::vector<Leaf> leaves;
  std::vector<ObjectPlace> objects;
  collect(schema(), Pointer(), leaves, objects);
  return leaves;
}

/// Adds what the schema requires beside what a file has.
void add_required(const json& node, json& value) {
  const json rule = resolved(node);
  if (!value.is_object() || !rule.contains("properties")) return;
  for (const json& key : rule.value("required", json::array())) {
    if (!value.contains(key)) value[key.get<std::string>()] = "required";
  }
  for (auto& [key, member] : value.items()) {
    if (rule.at("properties").contains(key)) add_required(rule.at("properties").at(key), member);
  }
}

/// \return the error for a file with this value and what it requires beside it; empty if it is
///   accepted
std::string refusal(const Pointer& place, const json& value) {
  json file = json::object();
  file[place] = value;
  add_required(schema(), file);
  try {
    static_cast<void>(device::parse_device_settings(file.dump(), "/lab", "devices.json"));
  } catch (const StudyError& error) {
    return error.what();
  }
  return "";
}

/// \return the keys that the reader knows in an object, by its own error
std::set<std::string> keys_of_reader(const Pointer& place) {
  return known_keys_in(refusal(place / "qqqqqqqqqqqqqqqqqqqq", 1));
}

/// \return for a list of three numbers: `number` first, with others that are valid beside it
json in_list(const json& rule, double number) {
  if (!rule.contains("uniqueItems")) {
    const double other = std::max(0.0, rule.at("items").at("minimum").get<double>());
    return json::array({number, other, other});
  }
  json list = json::array({number});
  for (int other = 0; list.size() < 3; ++other) {
    if (other != number) list.push_back(other);
  }
  return list;
}

double step_of(const json& rule) {
  return rule.at("type") == "integer" ? 1.0 : 1e-9;
}

/// Tries one bound, and the nearest number beyond it.
/// \return whether the schema has the bound
bool holds_bound(const Leaf& leaf, const char* word, double outwards, bool belongs) {
  const bool listed = leaf.rule.contains("items");
  const json rule = listed ? leaf.rule.at("items") : leaf.rule;
  if (!rule.contains(word)) return false;
  const double bound = rule.at(word);
  const auto with = [&](double number) {
    return refusal(leaf.place, listed ? in_list(leaf.rule, number) : json(number));
  };
  INFO(leaf.place.to_string() << " " << word);
  CHECK(with(bound).empty() == belongs);
  CHECK_FALSE(with(bound + outwards * step_of(rule)).empty());
  CHECK(with(bound - outwards * step_of(rule)).empty());
  return true;
}

}  // namespace

TEST_CASE("the schema of device settings and the reader know the same keys") {
  std::vector<Leaf> leaves;
  std::vector<ObjectPlace> objects;
  collect(schema(), Pointer(), leaves, objects);
  for (const ObjectPlace& object : objects) {
    INFO("in " << object.place.to_string());
    std::set<std::string> in_schema;
    for (const auto& [key, unused] : object.rule.at("properties").items()) in_schema.insert(key);
    CHECK(keys_of_reader(object.place) == in_schema);
  }
  CHECK(objects.size() == 1 + 8 + 8 + 5 + 3);
  CHECK(leaves.size() == 7 + 3 + 7 + 2 + 5 + 1 + 8 * 4 + 5 * 2 + 5 + 2 + 5 * 4 + 1);
}

TEST_CASE("in the schema of device settings a product's section is that of its driver") {
  int products = 0;
  for (const device::DeviceDriver& driver : device::device_drivers()) {
    for (const std::string_view name : driver.names()) {
      if (name == driver.name) continue;
      INFO(name);
      CHECK(schema().at("properties").at(std::string(name)).at("$ref") ==
            "#/properties/" + driver.name);
      ++products;
    }
  }
  CHECK(products > 10);
}

TEST_CASE("the reader keeps the bounds of the schema of device settings") {
  int bounds = 0;
  for (const Leaf& leaf : all_leaves()) {
    bounds += holds_bound(leaf, "minimum", -1.0, true) ? 1 : 0;
    bounds += holds_bound(leaf, "maximum", 1.0, true) ? 1 : 0;
    bounds += holds_bound(leaf, "exclusiveMinimum", -1.0, false) ? 1 : 0;
  }
  CHECK(bounds == 2 * (5 + 1 + 5 + 3 + 8 * 4 + 5 + 3 + 5 * 4 + 1));
}

TEST_CASE("the reader keeps the types of the schema of device settings") {
  for (const Leaf& leaf : all_leaves()) {
    if (is_scale(leaf)) continue;
    const std::string type = leaf.rule.at("type");
    const json number = type == "integer" ? leaf.rule.at("default") : json(1);
    for (const json& value :
         {json("horizontal"), number, json(true), json::array({0, 1, 2}), json::object(), json()}) {
      const bool is_word =
          !leaf.rule.contains("enum") ||
          std::ranges::find(leaf.rule.at("enum"), value) != leaf.rule.at("enum").end();
      const bool fits = (type == "string" && value.is_string() && is_word) ||
                        ((type == "number" || type == "integer") && value.is_number()) ||
                        (type == "boolean" && value.is_boolean()) ||
                        (type == "object" && value.is_object()) ||
                        (type == "array" && value.is_array());
      // [0, 1, 2] is neither a gravity bias nor a size: its numbers are too large, or too small.
      if (fits && (leaf.place.back() == "gravity_bias_n" || leaf.place.back() == "workspace_mm"))
        continue;
      INFO(leaf.place.to_string() << " = " << value.dump());
      CHECK(refusal(leaf.place, value).empty() == fits);
    }
  }
}

TEST_CASE("the reader takes a scale as a number or as a list of three, as the schema does") {
  int scales = 0;
  for (const Leaf& leaf : all_leaves()) {
    if (!is_scale(leaf)) continue;
    INFO(leaf.place.to_string());
    CHECK(refusal(leaf.place, 1.5).empty());
    CHECK(refusal(leaf.place, json::array({0.5, 1, 2})).empty());
    for (const json& value : {json("1"), json(true), json::object(), json(), json::array()})
      CHECK_FALSE(refusal(leaf.place, value).empty());
    ++scales;
  }
  CHECK(scales == 5 * 4);
}

TEST_CASE("the reader keeps the words, lengths and defaults of the schema of device settings") {
  int words = 0;
  int lists = 0;
  int texts = 0;
  for (const Leaf& leaf : all_leaves()) {
    INFO(leaf.place.to_string());
    if (leaf.rule.contains("enum")) {
      for (const json& word : leaf.rule.at("enum")) CHECK(refusal(leaf.place, word).empty());
      CHECK_FALSE(refusal(leaf.place, "diagonal").empty());
      ++words;
    }
    if (leaf.rule.contains("pattern")) {
      CHECK(leaf.rule.at("pattern") == R"(^[^\u0000-\u001f\u007f]*$)");
      for (const char* text : {"\x01", "a\x1f", "a\x7fz"})
        CHECK_FALSE(refusal(leaf.place, text).empty());
      CHECK(refusal(leaf.place, "a b").empty());
      ++texts;
    }
    if (leaf.rule.at("type") == "string" && !leaf.rule.contains("enum")) {
      CHECK(refusal(leaf.place, "").empty() == !leaf.rule.contains("minLength"));
    }
    if (leaf.rule.at("type") == "array") {
      CHECK_FALSE(refusal(leaf.place, json::array({0, 0})).empty());
      CHECK_FALSE(refusal(leaf.place, json::array({0, 0, 0, 0})).empty());
      ++lists;
    }
    if (leaf.rule.contains("default")) CHECK(refusal(leaf.place, leaf.rule.at("default")).empty());
  }
  CHECK(words == 5 + 1);
  CHECK(lists == 8 + 5 * 2);
  CHECK(texts == 9 + 3);
}

TEST_CASE("the defaults of the schema of device settings are the reader's") {
  json file = json::object();
  for (const Leaf& leaf : all_leaves()) {
    if (leaf.rule.contains("default")) file[leaf.place] = leaf.rule.at("default");
  }
  add_required(schema(), file);
  const device::DeviceSettings written =
      device::parse_device_settings(file.dump(), "/lab", "devices.json");
  const device::DeviceSettings bare;
  CHECK(written.instruments.serial.baud == bare.instruments.serial.baud);
  CHECK(written.instruments.serial.format == bare.instruments.serial.format);
  CHECK(written.instruments.serial.width == bare.instruments.serial.width);
  CHECK(written.instruments.serial.reset_ms == bare.instruments.serial.reset_ms);
  CHECK(written.instruments.lsl.name == bare.instruments.lsl.name);
  CHECK(written.falcon.serial == bare.falcon.serial);
  CHECK(written.falcon.gravity_bias_n == bare.falcon.gravity_bias_n);
  CHECK(written.falcon.led_order == bare.falcon.led_order);
  CHECK(written.falcon.motor_peak == bare.falcon.motor_peak);
  CHECK(written.falcon.motor_continuous == bare.falcon.motor_continuous);
  CHECK(written.falcon.motor_peak_s == bare.falcon.motor_peak_s);
  CHECK(written.openhaptics.library == bare.openhaptics.library);
  CHECK(written.openhaptics.device == bare.openhaptics.device);
  CHECK(written.openhaptics.rate_hz == bare.openhaptics.rate_hz);
  CHECK(written.dhd.library == bare.dhd.library);
  CHECK(written.dhd.index == bare.dhd.index);
  CHECK(written.dhd.gravity_compensation == bare.dhd.gravity_compensation);
  CHECK(written.dhd.effector_mass_kg == bare.dhd.effector_mass_kg);
  CHECK(written.plugin.settings == bare.plugin.settings);
  CHECK(written.inverse3.host == bare.inverse3.host);
  CHECK(written.inverse3.port == bare.inverse3.port);
  CHECK(written.inverse3.events_port == bare.inverse3.events_port);
  CHECK(written.inverse3.http_port == bare.inverse3.http_port);
  CHECK(written.inverse3.device_id == bare.inverse3.device_id);
  CHECK(written.inverse3.max_force_n == bare.inverse3.max_force_n);
}

TEST_CASE("what the schema of device settings requires, the reader requires") {
  std::vector<Leaf> leaves;
  std::vector<ObjectPlace> objects;
  collect(schema(), Pointer(), leaves, objects);
  int required = 0;
  for (const ObjectPlace& object : objects) {
    for (const json& key : object.rule.value("required", json::array())) {
      INFO(object.place.to_string() << " without " << key);
      json file = json::object();
      file[object.place] = json::object();
      CHECK_THROWS_AS(device::parse_device_settings(file.dump(), "/lab", "devices.json"),
                      StudyError);
      ++required;
    }
  }
  CHECK(required == 1);
}

TEST_CASE("examples of the schema of device settings are accepted") {
  for (const json& example : schema().at("examples")) {
    CHECK_NOTHROW(device::parse_device_settings(example.dump(), "/lab", "devices.json"));
  }
}

}  // namespace touchtrial
