/// \file Settings that are described once. A function `describe(io, value)` lists the keys of a
/// struct, each with its type, range and meaning; the reader of a file, its writer, the JSON Schema
/// and the tables of the documentation all call it. Units are in the names of keys.
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

/// What is said of a key besides type and range.
struct About {
  std::string_view meaning{};            ///< a sentence or two for people; Markdown
  bool required = false;                 ///< the file must have the key
  bool if_changed = false;               ///< written only where it differs from the default
  bool written = true;                   ///< whether this value is written at all
  std::string_view unit{};               ///< where the key's name does not tell it
  std::string_view otherwise{};          ///< the default in words, where it is no fixed value
  std::string_view range{};              ///< in words, in place of what type and limits say
  std::vector<std::string_view> also{};  ///< other names of the key
};

/// How a text may be.
struct TextRule {
  void (*check)(const JsonValue& place) = nullptr;  ///< refuses what does not fit, with a remedy
  std::size_t min_length = 0;
  std::size_t max_length = 0;      ///< 0: no limit
  std::string_view pattern = {};   ///< regular expression of JSON Schema
  std::string_view in_words = {};  ///< for tables
};

struct ListRange {
  std::size_t fewest = 0;
  std::size_t most = 0;
  bool unique = false;  ///< for the schema; a rule refuses what is there twice
};

class ObjectIo;

/// One value of a file: a place that is read, written or described. Each function takes the value
/// that is there (written, or the default), or puts there what a file says.
class ValueIo {
 public:
  /// One of several forms of a value. The first that fits is read, else the last.
  struct Form {
    std::function<bool(const JsonValue& place)> fits;
    std::function<void(ValueIo& io)> describe;
  };

  ValueIo() = default;
  ValueIo(const ValueIo&) = delete;
  ValueIo& operator=(const ValueIo&) = delete;
  virtual ~ValueIo() = default;

  virtual void number(double& value, const NumberRange& range) = 0;
  virtual void truth(bool& value) = 0;
  virtual void text(std::string& value, const TextRule& rule) = 0;
  /// \param written  the form in which the value is written
  virtual void either(std::size_t written, std::span<const Form> forms) = 0;
  virtual void object(const std::function<void(ObjectIo& io)>& describe) = 0;
  /// A rule about what has been read, called only while a file is read.
  /// \param rule  throws by refuse() of the place
  virtual void rule(const std::function<void(const JsonValue& place)>& rule) = 0;
  /// A value with a reader of its own.
  /// \param schema  JSON
  /// \param text  gives the value as JSON
  virtual void own(std::string_view schema, const std::function<void(const JsonValue& place)>& read,
                   const std::function<std::string()>& text) = 0;

  template <std::integral Whole>
  void integer(Whole& value, std::int64_t low, std::int64_t high) {
    auto whole = static_cast<std::int64_t>(value);
    whole_number(whole, low, high);
    value = static_cast<Whole>(whole);
  }

  /// One of the words of a table.
  template <typename Value, std::size_t size>
  void choice(Value& value, const std::array<Named<Value>, size>& table) {
    std::size_t at = 0;
    while (at < size && table[at].value != value) ++at;
    word(at, names_in(table));
    if (at < size) value = table[at].value;
  }
  /// One of the words of a list that is made at run time, by its index.
  void choice(std::size_t& at, std::span<const std::string_view> words) { word(at, words); }

  /// \param describe  (ValueIo&, Item&)
  template <typename Item, typename Describe>
  void list(std::vector<Item>& items, const ListRange& range, const Describe& describe) {
    entries(range, {[&] { return items.size(); }, [&](std::size_t n) { items.assign(n, Item{}); },
                    [&](ValueIo& io, std::size_t at) { describe(io, items[at]); },
                    [&](ValueIo& io) {
                      Item usual{};
                      describe(io, usual);
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
    std::function<void(ValueIo& io, std::size_t at)> describe;
    std::function<void(ValueIo& io)> describe_usual;
  };
  virtual void whole_number(std::int64_t& value, std::int64_t low, std::int64_t high) = 0;
  virtual void word(std::size_t& at, std::span<const std::string_view> words) = 0;
  virtual void entries(const ListRange& range, const Entries& entries) = 0;
};

/// The keys of one object. While a file is read, keys are taken in the order of the description, so
/// that a default may follow from keys above; the description is run once before that, to learn the
/// keys.
class ObjectIo {
 public:
  using Describe = std::function<void(ValueIo& io)>;
  /// Throws by refuse() of the object's place; `object` says which keys there are.
  using Rule = std::function<void(const JsonValue& place, const JsonObject& object)>;

  ObjectIo() = default;
  ObjectIo(const ObjectIo&) = delete;
  ObjectIo& operator=(const ObjectIo&) = delete;
  virtual ~ObjectIo() = default;

  /// \param is_there  whether there is a value, to be written or as a default
  virtual void member(std::string_view key, const About& about, bool is_there,
                      const Describe& describe) = 0;
  /// A rule between keys, called only while a file is read, in its turn.
  virtual void rule(const Rule& rule) = 0;
  /// These keys are for some words of another key alone. Say so before them.
  /// \param otherwise  what is said, with the remedy, of such a key beside another word
  virtual void only_for(std::string_view key, std::span<const std::string_view> words,
                        std::span<const std::string_view> keys, const std::string& otherwise) = 0;

  void number(std::string_view key, double& value, const NumberRange& range, const About& about) {
    member(key, about, true, [&](ValueIo& io) { io.number(value, range); });
  }
  void number(std::string_view key, std::optional<double>& value, const NumberRange& range,
              const About& about) {
    optional(key, value, about, [&](ValueIo& io, double& number) { io.number(number, range); });
  }
  template <std::integral Whole>
  void integer(std::string_view key, Whole& value, std::int64_t low, std::int64_t high,
               const About& about) {
    member(key, about, true, [&](ValueIo& io) { io.integer(value, low, high); });
  }
  void truth(std::string_view key, bool& value, const About& about) {
    member(key, about, true, [&](ValueIo& io) { io.truth(value); });
  }
  void text(std::string_view key, std::string& value, const TextRule& rule, const About& about) {
    member(key, about, true, [&](ValueIo& io) { io.text(value, rule); });
  }
  template <typename Value, std::size_t size>
  void choice(std::string_view key, Value& value, const std::array<Named<Value>, size>& table,
              const About& about) {
    member(key, about, true, [&](ValueIo& io) { io.choice(value, table); });
  }
  template <typename Item, typename Describe>
  void list(std::string_view key, std::vector<Item>& items, const ListRange& range,
            const About& about, const Describe& describe) {
    member(key, about, true, [&](ValueIo& io) { io.list(items, range, describe); });
  }
  template <typename Part, typename Describe>
  void part(std::string_view key, Part& value, const About& about, const Describe& describe) {
    member(key, about, true, [&](ValueIo& io) { io.part(value, describe); });
  }
  /// Any value that may be missing.
  /// \param describe  (ValueIo&, Value&)
  template <typename Value, typename Describe>
  void optional(std::string_view key, std::optional<Value>& value, const About& about,
                const Describe& describe) {
    member(key, about, value.has_value(), [&](ValueIo& io) {
      if (!value) value.emplace();
      describe(io, *value);
    });
  }
};

/// The keys of a struct, as the visitors below call them.
using Description = std::function<void(ObjectIo& io)>;

/// The keys of an object, without other names of them.
[[nodiscard]] std::vector<std::string_view> keys_of(const Description& description);

/// Reads an object: refuses unknown keys and values that the description does not allow.
/// \throws StudyError with the place
void read_described(const JsonValue& place, const Description& description);

enum class WrittenKeys {
  all,     ///< every key but those that have no value, and unchanged ones that are if_changed()
  changed  ///< keys that differ from their defaults
};

/// \param usual  the same of a struct with its defaults
/// \return JSON on one line, in the order of the description
[[nodiscard]] std::string written_as_described(const Description& description,
                                               const Description& usual,
                                               WrittenKeys keys = WrittenKeys::all);

/// One value, as JSON on one line.
[[nodiscard]] std::string written_as_described(const std::function<void(ValueIo& io)>& describe);

/// A JSON Schema (draft 2020-12) of files of this description, and what tables need beside it, in
/// keys that begin with "x-".
/// \param examples  a JSON list
/// \return JSON
[[nodiscard]] std::string annotated_schema(std::string_view title, std::string_view about,
                                           std::string_view examples, const Description& usual);

/// The same of an object within a schema, for ValueIo::own().
[[nodiscard]] std::string annotated_section(const About& about, const Description& usual);

/// The schema without what only tables need, as config/schema has it.
[[nodiscard]] std::string plain_schema(std::string_view annotated);

/// A Markdown table of the keys of one object: key, type and unit, range, default, meaning.
/// \param pointer  JSON pointer of the object in the schema
/// \param nested  whether keys of objects in it have rows here: `outer.inner`
/// \throws StudyError if there is no such object
[[nodiscard]] std::string table_of_settings(std::string_view annotated, const std::string& pointer,
                                            bool nested);

}  // namespace touchtrial
