/// \file The tables of the documentation, from an annotated schema.
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

/// "115,200"
std::string in_thousands(double number) {
  std::string text = number_text(number);
  const bool is_whole = text.find_first_not_of("-0123456789") == std::string::npos;
  if (!is_whole || std::abs(number) < 1e5 || std::abs(number) > 1e9) return text;
  for (std::size_t at = text.size(); at > 3 + (number < 0.0 ? 1U : 0U);) {
    at -= 3;
    text.insert(at, ",");
  }
  return text;
}

std::string limits_text(const ordered_json& rule) {
  const bool open_low = rule.contains("exclusiveMinimum");
  const bool open_high = rule.contains("exclusiveMaximum");
  const std::string low = in_thousands(rule.at(open_low ? "exclusiveMinimum" : "minimum"));
  const std::string high = in_thousands(rule.at(open_high ? "exclusiveMaximum" : "maximum"));
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
  const std::string of = type_text(rule.at("items"));
  return "list of " + of + (of == "text" ? "" : "s");
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
    const std::string of = range_text(rule["items"]);
    const std::string count =
        min_count == max_count
            ? std::to_string(max_count)
            : std::to_string(min_count) + " to " + in_thousands(static_cast<double>(max_count));
    return count + (of.empty() ? " entries" : ", each " + of);
  }
  if (rule.contains("minimum") || rule.contains("exclusiveMinimum")) return limits_text(rule);
  if (rule.contains("maxLength")) {
    const auto min_count = rule.value("minLength", std::size_t{0});
    const std::string max_count =
        in_thousands(static_cast<double>(rule["maxLength"].get<std::size_t>())) + " bytes";
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
    return defaults.empty() ? "none"
                            : listed(defaults, ", ", [](const auto& one) { return one.dump(); });
  }
  if (defaults.is_object()) return code(defaults.dump());
  return defaults.is_number() ? in_thousands(defaults) : defaults.dump();
}

/// Makes the rows of a table.
class Rows {
 public:
  explicit Rows(bool nested) : nested_(nested) {}

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

  /// \param outer  before the keys: "hand."
  /// \param left_out  keys that have rows elsewhere
  void add_object(const ordered_json& object, const std::string& outer,
                  const std::vector<std::string>& left_out = {}) {
    const Shared shared = shared_by_inner(object);
    for (const auto& [key, rule] : object.at("properties").items()) {
      if (rule.contains("$ref") || std::ranges::count(left_out, key) > 0) continue;
      add(key, rule, is_required(object, key), outer, keys_of_shared(shared, rule));
    }
    for (const auto& [key, rule, owners] : shared) {
      if (owners.size() < kMinOwners) continue;
      ordered_json of_all = rule;
      of_all[kMeaning] = rule.at(kMeaning).get<std::string>() + " (of " + listed(owners) + ")";
      add(key, of_all, false, outer + "NAME.", {});
    }
  }

 private:
  /// A key that several objects have alike.
  struct SharedKey {
    std::string key;
    ordered_json rule;
    std::vector<std::string> owners;
  };
  using Shared = std::vector<SharedKey>;
  static constexpr std::size_t kMinOwners = 3;

  [[nodiscard]] static bool is_required(const ordered_json& object, const std::string& key) {
    const ordered_json required = object.value("required", ordered_json::array());
    return std::find(required.begin(), required.end(), key) != required.end();
  }

  [[nodiscard]] bool is_opened(const ordered_json& rule) const {
    return nested_ && rule.contains("properties") && !rule.contains(kRange);
  }

  [[nodiscard]] Shared shared_by_inner(const ordered_json& object) const {
    Shared shared;
    for (const auto& [owner, inner] : object.at("properties").items()) {
      if (!is_opened(inner)) continue;
      for (const auto& entry : inner.at("properties").items()) {
        const auto same = std::ranges::find_if(shared, [&](const SharedKey& one) {
          return one.key == entry.key() && one.rule == entry.value();
        });
        if (same != shared.end()) {
          same->owners.push_back(owner);
        } else {
          shared.push_back({entry.key(), entry.value(), {owner}});
        }
      }
    }
    return shared;
  }

  [[nodiscard]] static std::vector<std::string> keys_of_shared(const Shared& shared,
                                                               const ordered_json& inner) {
    std::vector<std::string> keys;
    if (!inner.contains("properties")) return keys;
    for (const SharedKey& one : shared) {
      const auto found = inner["properties"].find(one.key);
      const bool has_it = found != inner["properties"].end() && *found == one.rule;
      if (has_it && one.owners.size() >= kMinOwners) keys.push_back(one.key);
    }
    return keys;
  }

  void add(const std::string& key, const ordered_json& rule, bool is_required,
           const std::string& outer, const std::vector<std::string>& left_out) {
    if (is_opened(rule)) {
      add_object(rule, outer + key + ".", left_out);
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
  const ordered_json::json_pointer at(pointer);
  if (!schema.contains(at) || !schema.at(at).contains("properties")) {
    throw StudyError(one_line("the schema has no object at " + pointer));
  }
  Rows rows(nested);
  rows.add_object(schema.at(at), "");
  return "| key | type and unit | range | default | meaning |\n| --- | --- | --- | --- | --- |\n" +
         rows.text();
}

}  // namespace touchtrial
