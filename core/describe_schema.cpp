/// \file Writes the JSON Schema of described settings.
#include "core/annotations.hpp"
#include "core/describe.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::ordered_json;

/// The unit that each suffix of a key stands for, longest suffix first.
constexpr auto kUnits = std::to_array<Named<std::string_view>>({{"_n_s_per_mm", "N s/mm"},
                                                                {"_n_s_per_m", "N s/m"},
                                                                {"_n_per_mm", "N/mm"},
                                                                {"_n_per_s", "N/s"},
                                                                {"_per_min", "1/min"},
                                                                {"_years", "years"},
                                                                {"_mm_s", "mm/s"},
                                                                {"_dbfs", "dB"},
                                                                {"_days", "days"},
                                                                {"_min", "min"},
                                                                {"_mm", "mm"},
                                                                {"_kg", "kg"},
                                                                {"_hz", "Hz"},
                                                                {"_px", "pixels"},
                                                                {"_db", "dB"},
                                                                {"_ms", "ms"},
                                                                {"_n", "N"},
                                                                {"_s", "s"},
                                                                {"_h", "h"}});

std::string_view unit_of(std::string_view key) {
  const auto* const match =
      std::ranges::find_if(kUnits, [key](const auto& unit) { return key.ends_with(unit.name); });
  return match == kUnits.end() ? std::string_view() : match->value;
}

/// Removes the decimal point of whole numbers.
ordered_json without_decimal_point(const ordered_json& value) {
  if (value.is_number_float()) return ordered_json::parse(number_text(value.get<double>()));
  ordered_json copy = value;
  if (copy.is_structured()) {
    for (ordered_json& inner : copy) inner = without_decimal_point(inner);
  }
  return copy;
}

class SchemaOfValue final : public ValueIo {
 public:
  SchemaOfValue(ordered_json& out, std::string pointer) : out_(out), pointer_(std::move(pointer)) {}

  void number(double& /*value*/, const NumberRange& range) override {
    out_["type"] = "number";
    out_[range.open_low ? "exclusiveMinimum" : "minimum"] = without_decimal_point(range.low);
    out_[range.open_high ? "exclusiveMaximum" : "maximum"] = without_decimal_point(range.high);
  }
  void boolean(bool& /*value*/) override { out_["type"] = "boolean"; }
  void text(std::string& /*value*/, const TextRule& rule) override {
    out_["type"] = "string";
    if (rule.min_length > 0) out_["minLength"] = rule.min_length;
    if (rule.max_length > 0) out_["maxLength"] = rule.max_length;
    if (!rule.pattern.empty()) out_["pattern"] = rule.pattern;
    if (!rule.description.empty()) out_[kRange] = rule.description;
  }
  void one_of(std::size_t /*form_index*/, std::span<const Form> forms) override {
    ordered_json list = ordered_json::array();
    for (const Form& form : forms) {
      const std::string pointer = pointer_ + "/anyOf/" + std::to_string(list.size());
      SchemaOfValue form_schema(list.emplace_back(ordered_json::object()), pointer);
      form.describe(form_schema);
    }
    out_["anyOf"] = std::move(list);
  }
  void object(const std::function<void(ObjectIo&)>& describe) override;
  void rule(const std::function<void(const JsonValue&)>& /*rule*/) override {}
  void custom(std::string_view schema, const std::function<void(const JsonValue&)>& /*read*/,
              const std::function<std::string()>& /*text*/) override {
    out_.update(ordered_json::parse(schema));
  }

 private:
  void integer_value(std::int64_t& /*value*/, std::int64_t low, std::int64_t high) override {
    out_["type"] = "integer";
    out_["minimum"] = low;
    out_["maximum"] = high;
  }
  void choice_index(std::size_t& /*index*/, std::span<const std::string_view> words) override {
    out_["type"] = "string";
    out_["enum"] = words;
  }
  void entries(const ListRange& range, const Entries& entries) override {
    out_["type"] = "array";
    if (range.min > 0) out_["minItems"] = range.min;
    out_["maxItems"] = range.max;
    if (range.unique) out_["uniqueItems"] = true;
    ordered_json items = ordered_json::object();
    SchemaOfValue item(items, pointer_ + "/items");
    entries.describe_default(item);
    out_["items"] = std::move(items);
  }

  ordered_json& out_;
  std::string pointer_;
};

class SchemaOfObject final : public ObjectIo {
 public:
  SchemaOfObject(ordered_json& out, std::string pointer)
      : out_(out), pointer_(std::move(pointer)) {}

  void member(std::string_view key, const KeyInfo& info, bool has_value,
              const Describe& describe) override {
    const std::string pointer = pointer_ + "/properties/" + std::string(key);
    ordered_json property = {{kMeaning, info.meaning}};
    const std::string_view unit = info.unit.empty() ? unit_of(key) : info.unit;
    if (!unit.empty()) property[kUnit] = unit;
    ordered_json defaults;
    const bool has_default = has_value && !info.required && info.default_text.empty();
    if (has_default)
      defaults = without_decimal_point(ordered_json::parse(described_json(describe)));
    SchemaOfValue value(property, pointer);
    describe(value);
    if (property.contains("properties")) {
      property.erase(kUnit);
    } else if (has_default) {
      property["default"] = std::move(defaults);
    }
    if (!info.default_text.empty()) property[kDefaultText] = info.default_text;
    if (!info.range.empty()) property[kRange] = info.range;
    properties_[std::string(key)] = std::move(property);
    if (info.required) required_.push_back(key);
    for (const std::string_view alias : info.aliases) {
      properties_[std::string(alias)] = {{"$ref", "#" + pointer}};
    }
  }
  void rule(const Rule& /*rule*/) override {}
  void only_for(std::string_view key, std::span<const std::string_view> words,
                std::span<const std::string_view> keys, const std::string& /*message*/) override {
    ordered_json forbidden = ordered_json::object();
    for (const std::string_view restricted : keys) forbidden[std::string(restricted)] = false;
    rules_.push_back({{"if", {{"properties", {{std::string(key), {{"enum", words}}}}}}},
                      {"else", {{"properties", std::move(forbidden)}}}});
  }

  void finish() {
    out_["type"] = "object";
    out_["additionalProperties"] = false;
    if (!required_.empty()) out_["required"] = std::move(required_);
    out_["properties"] = std::move(properties_);
    if (!rules_.empty()) out_["allOf"] = std::move(rules_);
  }

 private:
  ordered_json& out_;
  std::string pointer_;
  ordered_json properties_ = ordered_json::object();
  ordered_json required_ = ordered_json::array();
  ordered_json rules_ = ordered_json::array();
};

void SchemaOfValue::object(const std::function<void(ObjectIo&)>& describe) {
  SchemaOfObject object(out_, pointer_);
  describe(object);
  object.finish();
}

/// "[text](page.md)" becomes "text".
std::string without_links(const std::string& text) {
  std::string plain;
  for (std::size_t position = 0; position < text.size(); ++position) {
    const std::size_t middle = text.find("](", position);
    const std::size_t end = middle == std::string::npos ? middle : text.find(')', middle);
    if (text[position] != '[' || end == std::string::npos) {
      plain += text[position];
      continue;
    }
    plain += text.substr(position + 1, middle - position - 1);
    position = end;
  }
  return plain;
}

/// Merges the annotations of each key into its description.
ordered_json without_annotations(const ordered_json& node) {
  if (node.is_array()) {
    ordered_json list = ordered_json::array();
    for (const ordered_json& item : node) list.push_back(without_annotations(item));
    return list;
  }
  if (!node.is_object()) return node;
  ordered_json plain = ordered_json::object();
  if (node.contains(kMeaning)) {
    std::string text = without_links(node[kMeaning].get<std::string>());
    if (node.contains(kUnit)) text += " [" + node[kUnit].get<std::string>() + "]";
    if (node.contains(kDefaultText)) {
      text += " (default: " + without_links(node[kDefaultText].get<std::string>()) + ")";
    }
    if (!text.empty()) plain["description"] = text;
  }
  for (const auto& [key, value] : node.items()) {
    if (!key.starts_with("x-")) plain[key] = without_annotations(value);
  }
  return plain;
}

/// JSON text with each list or object on one line if it fits.
std::string compact_json(const ordered_json& value, std::size_t indent) {
  constexpr std::size_t kColumns = 100;
  const bool is_object = value.is_object();
  if (!value.is_structured() || value.empty()) return value.dump();
  std::vector<std::string> parts;
  std::size_t length = indent;
  for (const auto& [key, inner] : value.items()) {
    const std::string name = is_object ? ordered_json(key).dump() + ": " : "";
    parts.push_back(name + compact_json(inner, indent + 2));
    length += parts.back().size() + 2;
    if (parts.back().find('\n') != std::string::npos) length += kColumns;
  }
  const bool fits = length <= kColumns;
  const std::string lead = fits ? "" : "\n" + std::string(indent + 2, ' ');
  std::string text(1, is_object ? '{' : '[');
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += lead + parts[i];
    if (i + 1 < parts.size()) text += fits ? ", " : ",";
  }
  if (!fits) text += "\n" + std::string(indent, ' ');
  return text + (is_object ? '}' : ']');
}

}  // namespace

std::string annotated_section(const KeyInfo& info, const Description& defaults) {
  ordered_json schema = {{kMeaning, info.meaning}};
  if (!info.default_text.empty()) schema[kDefaultText] = info.default_text;
  SchemaOfObject object(schema, "");
  defaults(object);
  object.finish();
  return schema.dump();
}

std::string annotated_schema(std::string_view title, std::string_view info,
                             std::string_view examples, const Description& defaults) {
  ordered_json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                         {"title", title},
                         {"description", info}};
  SchemaOfObject object(schema, "");
  defaults(object);
  object.finish();
  if (!examples.empty()) schema["examples"] = ordered_json::parse(examples);
  return schema.dump();
}

std::string plain_schema(std::string_view annotated) {
  return compact_json(without_annotations(ordered_json::parse(annotated)), 0) + "\n";
}

}  // namespace touchtrial
