/// \file Writes the tables of settings in the documentation from an annotated schema.
#include "core/annotations.hpp"
#include "core/describe.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::ordered_json;

/// Formats a number with thousands separators: "115,200".
std::string with_separators(double number) {
  std::string text = number_text(number);
  const bool is_whole = text.find_first_not_of("-0123456789") == std::string::npos;
  if (!is_whole || std::abs(number) < 1e5 || std::abs(number) > 1e9) return text;
  for (std::size_t position = text.size(); position > 3 + (number < 0.0 ? 1U : 0U);) {
    position -= 3;
    text.insert(position, ",");
  }
  return text;
}

std::string limits_text(const ordered_json& rule) {
  const bool open_low = rule.contains("exclusiveMinimum");
  const bool open_high = rule.contains("exclusiveMaximum");
  const std::string low = with_separators(rule.at(open_low ? "exclusiveMinimum" : "minimum"));
  const std::string high = with_separators(rule.at(open_high ? "exclusiveMaximum" : "maximum"));
  if (open_low && open_high) return "between " + low + " and " + high;
  if (open_low) return "above " + low + ", to " + high;
  return low + (open_high ? " to below " : " to ") + high;
}

std::string code(const std::string& text) {
  return "`" + text + "`";
}

std::string type_text(const ordered_json& rule) {
  if (rule.contains("anyOf")) {
    std::vector<std::string> types;
    for (const ordered_json& form : rule["anyOf"]) {
      if (std::string type = type_text(form); std::ranges::count(types, type) == 0) {
        types.push_back(std::move(type));
      }
    }
    return listed(types, " or ");
  }
  if (rule.contains("enum")) return "word";
  const std::string type = rule.value("type", "");
  if (type == "integer") return "whole number";
  if (type == "boolean") return "true or false";
  if (type == "string") return "text";
  if (type != "array") return type;
  const std::string item_type = type_text(rule.at("items"));
  return "list of " + item_type + (item_type == "text" ? "" : "s");
}

std::string range_text(const ordered_json& rule) {
  if (rule.contains(kRange)) return rule[kRange];
  if (rule.contains("anyOf")) {
    std::vector<std::string> ranges;
    for (const ordered_json& form : rule["anyOf"]) {
      if (std::string range = range_text(form); !range.empty()) ranges.push_back(range);
    }
    return listed(ranges, "; or ");
  }
  if (rule.contains("enum")) {
    return listed(rule["enum"].get<std::vector<std::string>>(), ", ", code);
  }
  if (rule.contains("items")) {
    const auto min_count = rule.value("minItems", std::size_t{0});
    const auto max_count = rule.at("maxItems").get<std::size_t>();
    const std::string item_range = range_text(rule["items"]);
    const std::string count =
        min_count == max_count
            ? std::to_string(max_count)
            : std::to_string(min_count) + " to " + with_separators(static_cast<double>(max_count));
    return count + (item_range.empty() ? " entries" : ", each " + item_range);
  }
  if (rule.contains("minimum") || rule.contains("exclusiveMinimum")) return limits_text(rule);
  if (rule.contains("maxLength")) {
    const auto min_count = rule.value("minLength", std::size_t{0});
    const std::string max_count =
        with_separators(static_cast<double>(rule["maxLength"].get<std::size_t>())) + " bytes";
    return min_count > 0 ? std::to_string(min_count) + " to " + max_count : "at most " + max_count;
  }
  return "";
}

std::string default_text(const ordered_json& rule, bool is_required) {
  if (is_required) return "required";
  if (rule.contains(kDefaultText)) return rule[kDefaultText];
  if (rule.contains("properties")) return rule.contains(kRange) ? "none" : "all defaults";
  if (!rule.contains("default")) return "none";
  const ordered_json& defaults = rule["default"];
  if (defaults.is_string()) return defaults == "" ? "empty" : code(defaults);
  if (defaults.is_array()) {
    return defaults.empty()
               ? "none"
               : listed(defaults, ", ", [](const auto& entry) { return entry.dump(); });
  }
  if (defaults.is_object()) return code(defaults.dump());
  return defaults.is_number() ? with_separators(defaults) : defaults.dump();
}

/// Collects the rows of a table.
class Rows {
 public:
  explicit Rows(bool nested) : nested_(nested) {}

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

  /// Adds one row per key.
  /// \param outer  prefix of the keys, for instance "hand."
  /// \param skipped_keys  keys described in other rows
  void add_object(const ordered_json& object, const std::string& outer,
                  const std::vector<std::string>& skipped_keys = {}) {
    const SharedKeys shared = find_shared_keys(object);
    for (const auto& [key, rule] : object.at("properties").items()) {
      if (rule.contains("$ref") || std::ranges::count(skipped_keys, key) > 0) continue;
      add(key, rule, is_required(object, key), outer, names_of_shared_keys(shared, rule));
    }
    for (const auto& [key, rule, objects] : shared) {
      if (objects.size() < kMinSharingObjects) continue;
      ordered_json shared_rule = rule;
      shared_rule[kMeaning] =
          rule.at(kMeaning).get<std::string>() + " (of " + listed(objects) + ")";
      add(key, shared_rule, false, outer + "NAME.", {});
    }
  }

 private:
  /// A key with the same rule in several nested objects.
  struct SharedKey {
    std::string key;
    ordered_json rule;
    std::vector<std::string> objects;
  };
  using SharedKeys = std::vector<SharedKey>;
  static constexpr std::size_t kMinSharingObjects = 3;

  [[nodiscard]] static bool is_required(const ordered_json& object, const std::string& key) {
    const ordered_json required = object.value("required", ordered_json::array());
    return std::find(required.begin(), required.end(), key) != required.end();
  }

  [[nodiscard]] bool has_nested_rows(const ordered_json& rule) const {
    return nested_ && rule.contains("properties") && !rule.contains(kRange);
  }

  [[nodiscard]] SharedKeys find_shared_keys(const ordered_json& object) const {
    SharedKeys shared;
    for (const auto& [name, inner] : object.at("properties").items()) {
      if (!has_nested_rows(inner)) continue;
      for (const auto& entry : inner.at("properties").items()) {
        const auto match = std::ranges::find_if(shared, [&](const SharedKey& candidate) {
          return candidate.key == entry.key() && candidate.rule == entry.value();
        });
        if (match != shared.end()) {
          match->objects.push_back(name);
        } else {
          shared.push_back({entry.key(), entry.value(), {name}});
        }
      }
    }
    return shared;
  }

  [[nodiscard]] static std::vector<std::string> names_of_shared_keys(const SharedKeys& shared,
                                                                     const ordered_json& inner) {
    std::vector<std::string> keys;
    if (!inner.contains("properties")) return keys;
    for (const SharedKey& candidate : shared) {
      const auto match = inner["properties"].find(candidate.key);
      const bool is_shared = match != inner["properties"].end() && *match == candidate.rule;
      if (is_shared && candidate.objects.size() >= kMinSharingObjects)
        keys.push_back(candidate.key);
    }
    return keys;
  }

  void add(const std::string& key, const ordered_json& rule, bool is_required,
           const std::string& outer, const std::vector<std::string>& skipped_keys) {
    if (has_nested_rows(rule)) {
      add_object(rule, outer + key + ".", skipped_keys);
      return;
    }
    std::string type = type_text(rule);
    if (rule.contains(kUnit)) type += ", " + rule[kUnit].get<std::string>();
    for (const std::string& cell :
         {code(outer + key), type, range_text(rule), default_text(rule, is_required),
          rule.at(kMeaning).get<std::string>()}) {
      text_ += cell.empty() ? "| " : "| " + cell + " ";
    }
    text_ += "|\n";
  }

  bool nested_;
  std::string text_;
};

}  // namespace

std::string table_of_settings(std::string_view annotated, const std::string& pointer, bool nested) {
  const ordered_json schema = ordered_json::parse(annotated);
  const ordered_json::json_pointer place(pointer);
  if (!schema.contains(place) || !schema.at(place).contains("properties")) {
    throw StudyError(one_line("the schema has no object at " + pointer));
  }
  Rows rows(nested);
  rows.add_object(schema.at(place), "");
  return "| key | type and unit | range | default | meaning |\n| --- | --- | --- | --- | --- |\n" +
         rows.text();
}

}  // namespace touchtrial
