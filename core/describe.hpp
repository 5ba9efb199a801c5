/// \file Describes each settings struct in one place. A function `describe(io, value)` lists its
/// keys, each with its type, range and meaning. The reader and the writer of a file, its JSON
/// Schema and the tables of the documentation all call this function. Key names end in their units.
#pragma once

#include "core/named.hpp"
#include "core/strict_json.hpp"
#include "core/vec.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial {

/// The properties of a key besides type and range.
struct KeyInfo {
  std::string_view meaning{};       ///< a sentence or two for people; Markdown
  bool required = false;            ///< the file must have the key
  bool if_changed = false;          ///< written only where it differs from the default
  bool written = true;              ///< false: the writer leaves this value out
  std::string_view unit{};          ///< if not in the key's name
  std::string_view default_text{};  ///< describes a default that is not a fixed value
  std::string_view range{};         ///< replaces the description derived from type and limits
  std::vector<std::string_view> aliases{};  ///< other names of the key
};

/// The constraints on a text.
struct TextRule {
  void (*check)(const JsonValue& place) = nullptr;  ///< throws with a remedy if the text is invalid
  std::size_t min_length = 0;
  std::size_t max_length = 0;         ///< 0: no limit
  std::string_view pattern = {};      ///< regular expression of JSON Schema
  std::string_view description = {};  ///< for tables
};

struct ListRange {
  std::size_t min = 0;
  std::size_t max = 0;
  bool unique = false;  ///< for the schema only; a rule must refuse duplicates
};

class ObjectIo;

/// Visits one value of a file. A reader sets the value, a writer outputs it, and a schema uses it
/// as the default.
class ValueIo {
 public:
  /// One of several forms of a value. A reader uses the first form that fits, or else the last.
  struct Form {
    std::function<bool(const JsonValue& place)> fits;
    std::function<void(ValueIo& io)> describe;
  };

  ValueIo() = default;
  ValueIo(const ValueIo&) = delete;
  ValueIo& operator=(const ValueIo&) = delete;
  virtual ~ValueIo() = default;

  virtual void number(double& value, const NumberRange& range) = 0;
  virtual void boolean(bool& value) = 0;
  virtual void text(std::string& value, const TextRule& rule) = 0;
  /// \param form_index  the form that a writer uses
  virtual void one_of(std::size_t form_index, std::span<const Form> forms) = 0;
  virtual void object(const std::function<void(ObjectIo& io)>& describe) = 0;
  /// Checks the value after reading; ignored by other visitors.
  /// \param rule  throws with JsonValue::refuse()
  virtual void rule(const std::function<void(const JsonValue& place)>& rule) = 0;
  /// A value with a custom reader.
  /// \param schema  JSON
  /// \param text  returns the value as JSON
  virtual void custom(std::string_view schema,
                      const std::function<void(const JsonValue& place)>& read,
                      const std::function<std::string()>& text) = 0;

  template <std::integral Integer>
  void integer(Integer& value, std::int64_t low, std::int64_t high) {
    auto number = static_cast<std::int64_t>(value);
    integer_value(number, low, high);
    value = static_cast<Integer>(number);
  }

  /// A value by its name in a table.
  template <typename Value, std::size_t size>
  void choice(Value& value, const std::array<Named<Value>, size>& table) {
    std::size_t index = 0;
    while (index < size && table[index].value != value) ++index;
    choice_index(index, names_in(table));
    if (index < size) value = table[index].value;
  }
  /// The index of a word in a list made at run time.
  void choice(std::size_t& index, std::span<const std::string_view> words) {
    choice_index(index, words);
  }

  /// \param describe  (ValueIo&, Item&)
  template <typename Item, typename Describe>
  void list(std::vector<Item>& items, const ListRange& range, const Describe& describe) {
    entries(range, {[&] { return items.size(); }, [&](std::size_t n) { items.assign(n, Item{}); },
                    [&](ValueIo& io, std::size_t index) { describe(io, items[index]); },
                    [&](ValueIo& io) {
                      Item defaults{};
                      describe(io, defaults);
                    }});
  }

  /// Three numbers: x, y and z.
  void axes(Vec3& value, const NumberRange& range);

  /// \param describe  (ObjectIo&, Part&)
  template <typename Part, typename Describe>
  void part(Part& value, const Describe& describe) {
    object([&](ObjectIo& io) { describe(io, value); });
  }

 protected:
  struct Entries {
    std::function<std::size_t()> size;
    std::function<void(std::size_t)> resize;
    std::function<void(ValueIo& io, std::size_t index)> describe;
    std::function<void(ValueIo& io)> describe_default;
  };
  virtual void integer_value(std::int64_t& value, std::int64_t low, std::int64_t high) = 0;
  virtual void choice_index(std::size_t& index, std::span<const std::string_view> words) = 0;
  virtual void entries(const ListRange& range, const Entries& entries) = 0;
};

/// Visits the keys of one object. A file is read in the order of the description, so that a default
/// can depend on earlier keys. Beforehand the description runs once to collect the keys.
class ObjectIo {
 public:
  using Describe = std::function<void(ValueIo& io)>;
  /// Throws with JsonValue::refuse(); `object` contains only the keys present in the file.
  using Rule = std::function<void(const JsonValue& place, const JsonObject& object)>;

  ObjectIo() = default;
  ObjectIo(const ObjectIo&) = delete;
  ObjectIo& operator=(const ObjectIo&) = delete;
  virtual ~ObjectIo() = default;

  /// \param has_value  whether there is a value to write or to use as the default
  virtual void member(std::string_view key, const KeyInfo& info, bool has_value,
                      const Describe& describe) = 0;
  /// Checks keys against each other. Called in order, only while a file is read.
  virtual void rule(const Rule& rule) = 0;
  /// Restricts keys to certain values of another key. Call it before describing them.
  /// \param message  the error and its remedy if a restricted key is present for another value
  virtual void only_for(std::string_view key, std::span<const std::string_view> words,
                        std::span<const std::string_view> keys, const std::string& message) = 0;

  void number(std::string_view key, double& value, const NumberRange& range, const KeyInfo& info) {
    member(key, info, true, [&](ValueIo& io) { io.number(value, range); });
  }
  void number(std::string_view key, std::optional<double>& value, const NumberRange& range,
              const KeyInfo& info) {
    optional(key, value, info, [&](ValueIo& io, double& number) { io.number(number, range); });
  }
  template <std::integral Integer>
  void integer(std::string_view key, Integer& value, std::int64_t low, std::int64_t high,
               const KeyInfo& info) {
    member(key, info, true, [&](ValueIo& io) { io.integer(value, low, high); });
  }
  void boolean(std::string_view key, bool& value, const KeyInfo& info) {
    member(key, info, true, [&](ValueIo& io) { io.boolean(value); });
  }
  void text(std::string_view key, std::string& value, const TextRule& rule, const KeyInfo& info) {
    member(key, info, true, [&](ValueIo& io) { io.text(value, rule); });
  }
  template <typename Value, std::size_t size>
  void choice(std::string_view key, Value& value, const std::array<Named<Value>, size>& table,
              const KeyInfo& info) {
    member(key, info, true, [&](ValueIo& io) { io.choice(value, table); });
  }
  template <typename Item, typename Describe>
  void list(std::string_view key, std::vector<Item>& items, const ListRange& range,
            const KeyInfo& info, const Describe& describe) {
    member(key, info, true, [&](ValueIo& io) { io.list(items, range, describe); });
  }
  template <typename Part, typename Describe>
  void part(std::string_view key, Part& value, const KeyInfo& info, const Describe& describe) {
    member(key, info, true, [&](ValueIo& io) { io.part(value, describe); });
  }
  /// An optional value.
  /// \param describe  (ValueIo&, Value&)
  template <typename Value, typename Describe>
  void optional(std::string_view key, std::optional<Value>& value, const KeyInfo& info,
                const Describe& describe) {
    member(key, info, value.has_value(), [&](ValueIo& io) {
      if (!value) value.emplace();
      describe(io, *value);
    });
  }
};

/// Describes the keys of a struct to a visitor.
using Description = std::function<void(ObjectIo& io)>;

/// The keys of an object, without aliases.
[[nodiscard]] std::vector<std::string_view> keys_of(const Description& description);

/// Reads an object. Refuses unknown keys and values outside the description.
/// \throws StudyError with the place
void read_settings(const JsonValue& place, const Description& description);

enum class WrittenKeys {
  all,     ///< every key with a value, except unchanged keys that are if_changed
  changed  ///< keys that differ from their defaults
};

/// \param defaults  describes a struct with default values
/// \return JSON on one line, in the order of the description
[[nodiscard]] std::string described_json(const Description& description,
                                         const Description& defaults,
                                         WrittenKeys keys = WrittenKeys::all);

/// One value, as JSON on one line.
[[nodiscard]] std::string described_json(const std::function<void(ValueIo& io)>& describe);

/// A JSON Schema (draft 2020-12) of files with this description. Keys that begin with "x-" are for
/// tables only.
/// \param examples  a JSON list
/// \return JSON
[[nodiscard]] std::string annotated_schema(std::string_view title, std::string_view info,
                                           std::string_view examples, const Description& defaults);

/// The schema of an object within another schema, for ValueIo::custom().
[[nodiscard]] std::string annotated_section(const KeyInfo& info, const Description& defaults);

/// The schema without the keys that only tables use, as in config/schema.
[[nodiscard]] std::string plain_schema(std::string_view annotated);

/// A Markdown table of the keys of one object: key, type and unit, range, default, meaning.
/// \param pointer  JSON pointer of the object in the schema
/// \param nested  whether keys of nested objects have rows too, as `outer.inner`
/// \throws StudyError if there is no such object
[[nodiscard]] std::string table_of_settings(std::string_view annotated, const std::string& pointer,
                                            bool nested);

}  // namespace touchtrial
