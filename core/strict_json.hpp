/// \file A strict reader for hand-written JSON files. It refuses unknown keys and values, and
/// its errors name the position in the file.
#pragma once

#include "core/named.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial {

/// The deepest nesting of containers that a file may have.
inline constexpr std::size_t kMaxJsonDepth = 16;

/// An interval of numbers. A bound belongs to it unless it is open.
struct NumberRange {
  double low = 0.0;
  double high = 0.0;
  bool open_low = false;
  bool open_high = false;

  [[nodiscard]] constexpr bool contains(double number) const noexcept {
    return (open_low ? number > low : number >= low) &&
           (open_high ? number < high : number <= high);
  }
};

class JsonObject;

/// A value and its place in the document. Every read throws StudyError
/// "SOURCE: POINTER: fault; remedy" if the value is not as requested. All values of a document
/// share its memory.
class JsonValue {
 public:
  /// \param fault  what is wrong, and the remedy
  /// \throws StudyError always
  [[noreturn]] void refuse(const std::string& fault) const;
  /// The same for a place below this one, which may be missing.
  /// \param pointer  from here, for instance "/trials/repeats"
  [[noreturn]] void refuse_below(std::string_view pointer, const std::string& fault) const;

  [[nodiscard]] bool is_text() const;
  [[nodiscard]] bool is_list() const;
  [[nodiscard]] bool is_object() const;
  [[nodiscard]] const std::string& text() const;
  /// true or false.
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] double number(const NumberRange& range) const;
  /// A whole number; 5.0 is accepted as 5.
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const;
  [[nodiscard]] std::vector<JsonValue> items(std::size_t min_count, std::size_t max_count) const;
  /// An object; refuses keys that are not in `known_keys`.
  [[nodiscard]] JsonObject object(std::span<const std::string_view> known_keys) const;
  [[nodiscard]] JsonObject object(std::initializer_list<std::string_view> known_keys) const;
  /// An object with keys unknown to this reader, as JSON on one line, without comments.
  [[nodiscard]] std::string object_text() const;
  /// The index of a text in `names`; any other text is refused.
  [[nodiscard]] std::size_t choice(std::span<const std::string_view> names) const;

  template <typename Value, std::size_t size>
  [[nodiscard]] Value choice(const std::array<Named<Value>, size>& table) const {
    return table[choice(std::span<const std::string_view>(names_in(table)))].value;
  }

 private:
  friend class JsonObject;
  friend JsonValue parse_strict_json(std::string_view text, const std::string& source);
  struct Node;

  explicit JsonValue(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
  [[noreturn]] void refuse_type(const std::string& expected) const;

  std::shared_ptr<const Node> node_;
};

/// An object whose keys have been checked.
class JsonObject {
 public:
  explicit JsonObject(JsonValue place) : place_(std::move(place)) {}

  /// \return the member, or nothing if the object has none of this name
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;
  /// \throws StudyError if the member is missing
  [[nodiscard]] JsonValue at(std::string_view key) const;

 private:
  JsonValue place_;
};

/// Parses JSON (RFC 8259) with comments: from // to the end of the line, or between /* and */.
/// Besides errors of grammar, it refuses a key that appears twice in an object, nesting deeper than
/// kMaxJsonDepth, numbers that exceed a double, and zero bytes.
/// \param source  the file's name, for messages
/// \return the whole document
/// \throws StudyError with line and column, or with the JSON pointer
[[nodiscard]] JsonValue parse_strict_json(std::string_view text, const std::string& source);

/// Converts a document for readers that do not support comments.
/// \param text  a document that parse_strict_json has read
/// \return the same text if it has no comment, else the document without comments
[[nodiscard]] std::string without_comments(std::string_view text);

/// A number as JSON writes it: the shortest form, with a decimal point in every locale.
[[nodiscard]] std::string number_text(double number);

/// The text of a document for files and commands: indented, ending with a line feed. Bytes that are
/// not UTF-8 become replacement characters.
template <typename Json>
[[nodiscard]] std::string json_text(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// A user's text for a message: in quotes, on one line, cut after about 60 bytes.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace touchtrial
