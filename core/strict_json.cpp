#include "core/strict_json.hpp"

#include "core/errors.hpp"
#include "core/nearest_name.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;

/// The longest start of a UTF-8 text with at most `limit` bytes and no incomplete character.
std::string_view beginning(std::string_view text, std::size_t limit) {
  if (text.size() <= limit) return text;
  while (limit > 0 && (static_cast<unsigned char>(text[limit]) & 0xc0U) == 0x80U) --limit;
  return text.substr(0, limit);
}

std::string escaped_token(std::string_view token) {
  constexpr std::size_t kMaxShownBytes = 80;
  std::string escaped = "/";
  for (const char c : beginning(token, kMaxShownBytes)) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

[[noreturn]] void refuse_at(const std::string& source, const std::string& place,
                            const std::string& fault) {
  throw StudyError(one_line(source + ": " + (place.empty() ? "/" : place) + ": " + fault));
}

/// Tracks the parser's position in the document.
class PlaceTracker {
 public:
  explicit PlaceTracker(const std::string& source) : source_(source) {}

  void follow(json::parse_event_t event, const json& parsed) {
    using Event = json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start) {
      if (levels_.size() == kMaxJsonDepth) {
        refuse_at(source_, pointer(), "is nested too deeply; use fewer levels");
      }
      levels_.push_back({event == Event::array_start, 0, {}, {}});
    } else if (event == Event::key) {
      enter_member(parsed.get_ref<const std::string&>());
    } else {
      if (event != Event::value) levels_.pop_back();
      if (!levels_.empty()) ++levels_.back().index;
    }
  }

  [[nodiscard]] std::string pointer() const {
    std::string text;
    for (const Level& level : levels_) {
      text += escaped_token(level.is_array ? std::to_string(level.index) : level.key);
    }
    return text;
  }

 private:
  struct Level {
    bool is_array;
    std::size_t index;
    std::string key;
    std::set<std::string> keys;
  };

  void enter_member(const std::string& key) {
    Level& level = levels_.back();
    level.key = key;
    if (!level.keys.insert(key).second) {
      refuse_at(source_, pointer(), "appears twice; keep one of the two");
    }
  }

  const std::string& source_;
  std::vector<Level> levels_;
};

[[noreturn]] void refuse_byte(std::string_view text, std::size_t byte_index,
                              const std::string& source, const std::string& fault) {
  const std::string_view preceding_text = text.substr(0, byte_index);
  const auto line = std::count(preceding_text.begin(), preceding_text.end(), '\n') + 1;
  const std::size_t column = byte_index - (preceding_text.rfind('\n') + 1) + 1;  // npos + 1 is 0
  throw StudyError(one_line(source + ": line " + std::to_string(line) + ", column " +
                            std::to_string(column) + ": " + fault));
}

[[noreturn]] void refuse_grammar(std::string_view text, const std::string& source,
                                 const json::parse_error& error) {
  const std::size_t byte_index = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
  // The library's message without its prefix and without the bytes that it last read.
  std::string fault = error.what();
  fault.erase(0, std::min(fault.find("syntax error"), fault.size()));
  fault = fault.substr(0, fault.find("; last read"));
  refuse_byte(text, byte_index, source,
              (fault.empty() ? "is not JSON" : fault) +
                  "; give JSON without trailing commas; // begins a comment");
}

/// Refuses zero bytes: the parser would stop at the first and ignore everything after it.
void refuse_zero_bytes(std::string_view text, const std::string& source) {
  const std::size_t byte_index = text.find('\0');
  if (byte_index == std::string_view::npos) return;
  refuse_byte(
      text, byte_index, source,
      "is a zero byte, which JSON does not allow; remove it and everything after it, or write "
      "the file again");
}

/// The value as a whole number, limited to 64 bits; nothing if it is not a whole number.
std::optional<std::int64_t> whole_number(const json& value) {
  using Limits = std::numeric_limits<std::int64_t>;
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    return number > static_cast<std::uint64_t>(Limits::max()) ? Limits::max()
                                                              : static_cast<std::int64_t>(number);
  }
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (!value.is_number_float()) return std::nullopt;
  const auto number = value.get<double>();
  if (number != std::floor(number)) return std::nullopt;
  if (number >= 0x1p63) return Limits::max();
  return number < -0x1p63 ? Limits::min() : static_cast<std::int64_t>(number);
}

std::string kind_of(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::boolean:
      return "true or false";
    case json::value_t::string:
      return "text";
    case json::value_t::array:
      return "a list";
    case json::value_t::object:
      return "an object";
    default:
      return value.is_number_float() ? "a number with decimals" : "a number";
  }
}

std::string list_of(std::span<const std::string_view> names, std::string_view quote) {
  return listed(names, ", ", [&](std::string_view name) {
    return std::string(quote) + std::string(name) + std::string(quote);
  });
}

std::string range_phrase(const NumberRange& range) {
  if (!range.open_low && !range.open_high) {
    return "from " + number_text(range.low) + " to " + number_text(range.high);
  }
  return (range.open_low ? "above " : "at least ") + number_text(range.low) + " and " +
         (range.open_high ? "below " : "at most ") + number_text(range.high);
}

}  // namespace

struct JsonValue::Node {
  std::shared_ptr<const json> document;  ///< keeps `value` alive
  const json* value;
  std::string source;
  std::string pointer;

  [[nodiscard]] JsonValue child(const json& member, std::string_view token) const {
    return JsonValue(std::make_shared<const Node>(
        Node{document, &member, source, pointer + escaped_token(token)}));
  }
};

JsonValue parse_strict_json(std::string_view text, const std::string& source) {
  refuse_zero_bytes(text, source);
  PlaceTracker tracker(source);
  const auto follow = [&tracker](int /*depth*/, json::parse_event_t event, json& parsed) {
    tracker.follow(event, parsed);
    return true;
  };
  try {
    auto document = std::make_shared<const json>(json::parse(
        text.begin(), text.end(), follow, /*allow_exceptions=*/true, /*ignore_comments=*/true));
    const json* root = document.get();
    return JsonValue(std::make_shared<const JsonValue::Node>(
        JsonValue::Node{std::move(document), root, source, ""}));
  } catch (const json::parse_error& error) {
    refuse_grammar(text, source, error);
  } catch (const json::out_of_range&) {
    refuse_at(source, tracker.pointer(), "is a number too large to hold; give a smaller one");
  }
}

std::string without_comments(std::string_view text) {
  if (json::accept(text)) return std::string(text);
  return nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/true,
                                       /*ignore_comments=*/true)
             .dump(2) +
         "\n";
}

void JsonValue::refuse(const std::string& fault) const {
  refuse_at(node_->source, node_->pointer, fault);
}

void JsonValue::refuse_below(std::string_view pointer, const std::string& fault) const {
  refuse_at(node_->source, node_->pointer + std::string(pointer), fault);
}

void JsonValue::refuse_type(const std::string& expected) const {
  refuse("must be " + expected + ", not " + kind_of(*node_->value));
}

bool JsonValue::is_text() const {
  return node_->value->is_string();
}

bool JsonValue::is_list() const {
  return node_->value->is_array();
}

bool JsonValue::is_object() const {
  return node_->value->is_object();
}

const std::string& JsonValue::text() const {
  if (!node_->value->is_string()) refuse_type("text in quotes");
  return node_->value->get_ref<const std::string&>();
}

bool JsonValue::boolean() const {
  if (!node_->value->is_boolean()) refuse_type("true or false");
  return node_->value->get<bool>();
}

double JsonValue::number(const NumberRange& range) const {
  if (!node_->value->is_number()) refuse_type("a number");
  const double number = node_->value->get<double>();
  if (!range.contains(number)) {
    refuse("is " + number_text(number) + ", must be " + range_phrase(range));
  }
  return number;
}

std::int64_t JsonValue::integer(std::int64_t low, std::int64_t high) const {
  const auto number = whole_number(*node_->value);
  if (!number) refuse_type("a whole number");
  if (*number < low || *number > high) {
    refuse("is " + node_->value->dump() + ", must be from " + std::to_string(low) + " to " +
           std::to_string(high));
  }
  return *number;
}

std::string JsonValue::object_text() const {
  if (!node_->value->is_object()) refuse_type("an object");
  return node_->value->dump();
}

std::vector<JsonValue> JsonValue::items(std::size_t min_count, std::size_t max_count) const {
  if (!node_->value->is_array()) refuse_type("a list");
  if (node_->value->size() < min_count || node_->value->size() > max_count) {
    refuse("has " + std::to_string(node_->value->size()) + " entries, must have from " +
           std::to_string(min_count) + " to " + std::to_string(max_count));
  }
  std::vector<JsonValue> items;
  items.reserve(node_->value->size());
  for (const json& item : *node_->value)
    items.push_back(node_->child(item, std::to_string(items.size())));
  return items;
}

JsonObject JsonValue::object(std::span<const std::string_view> known_keys) const {
  if (!node_->value->is_object()) refuse_type("an object");
  for (const auto& [key, value] : node_->value->items()) {
    if (std::find(known_keys.begin(), known_keys.end(), key) != known_keys.end()) continue;
    const auto nearest = nearest_name(key, known_keys);
    const std::string advice = nearest ? "did you mean " + in_quotes(*nearest) + "?"
                                       : "known here: " + list_of(known_keys, "");
    node_->child(value, key).refuse("is not a known key; " + advice);
  }
  return JsonObject(*this);
}

JsonObject JsonValue::object(std::initializer_list<std::string_view> known_keys) const {
  return object(std::span<const std::string_view>(known_keys.begin(), known_keys.size()));
}

std::size_t JsonValue::choice(std::span<const std::string_view> names) const {
  const std::string& name = text();
  const auto match = std::find(names.begin(), names.end(), name);
  if (match != names.end()) return static_cast<std::size_t>(match - names.begin());
  const auto nearest = nearest_name(name, names);
  refuse(in_quotes(name) + " is not known to this version; " +
         (nearest ? "did you mean " + in_quotes(*nearest) + "? " : "") +
         "possible: " + list_of(names, "\""));
}

std::optional<JsonValue> JsonObject::find(std::string_view key) const {
  const auto member = place_.node_->value->find(std::string(key));
  if (member == place_.node_->value->end()) return std::nullopt;
  return place_.node_->child(*member, key);
}

JsonValue JsonObject::at(std::string_view key) const {
  if (auto member = find(key)) return *member;
  place_.refuse_below(escaped_token(key), "is missing; add it");
}

std::string number_text(double number) {
  const bool is_whole = number == std::floor(number) && std::abs(number) < 0x1.0p53;
  return is_whole ? std::to_string(static_cast<std::int64_t>(number)) : json(number).dump();
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxShownBytes = 60;
  const std::string_view shown = beginning(text, kMaxShownBytes);
  return one_line("\"" + std::string(shown) + (shown.size() < text.size() ? "...\"" : "\""));
}

}  // namespace touchtrial
