/// \file The members of an event's body, described once: a struct of session_bodies.hpp or
/// file_bodies.hpp lists its members in `describe(BodyIo& io)`, and writer, reader, the split into
/// clear and sealed members and the data dictionary follow from that.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::record {

/// Attributes of a member besides its type and meaning. Keys name their units.
struct MemberNote {
  std::int64_t min = 0;  ///< of an integer
  bool sealed = false;   ///< absent unless the event is opened
};

/// A visitor of a body: a writer, a reader, or a list of its members. A member is required unless
/// its type or omit_if_empty() or omit_if() makes it optional. All functions throw StoreError that
/// names the key.
class BodyIo {
 public:
  struct Member {
    std::string_view key;
    std::string_view meaning;  ///< Markdown
    MemberNote note{};
    bool optional = false;
  };

  BodyIo() = default;
  BodyIo(const BodyIo&) = delete;
  BodyIo& operator=(const BodyIo&) = delete;
  virtual ~BodyIo() = default;

  template <typename Value>
  void operator()(std::string_view key, Value& value, std::string_view meaning,
                  const MemberNote& note = {}) {
    visit({key, meaning, note}, value);
  }
  /// Omits the key if the value is 0, false or empty.
  template <typename Value>
  void omit_if_empty(std::string_view key, Value& value, std::string_view meaning,
                     const MemberNote& note = {}) {
    omit_if(Value{}, key, value, meaning, note);
  }
  /// Omits the key if the value is `default_value`.
  template <typename Value>
  void omit_if(const Value& default_value, std::string_view key, Value& value,
               std::string_view meaning, const MemberNote& note = {}) {
    const Member member{key, meaning, note, /*optional=*/true};
    if (has(member, value != default_value)) put(member, value);
  }
  /// An enumeration, stored as a word. `words` are in the order of its enumerators.
  template <typename Value, std::size_t size>
  void choice(std::string_view key, Value& value, const std::array<std::string_view, size>& words,
              std::string_view meaning) {
    auto index = static_cast<std::size_t>(value);
    word({key, meaning}, index, words);
    value = static_cast<Value>(index);
  }
  /// An optional nested object.
  template <typename Part>
  void part(std::string_view key, std::optional<Part>& value, std::string_view meaning) {
    const Member member{key, meaning, {}, /*optional=*/true};
    if (!has(member, value.has_value())) return;
    if (!value) value.emplace();
    object(member, [&](BodyIo& io) { value->describe(io); });
  }

  /// Whether values are read from a body; only then must they be checked.
  [[nodiscard]] virtual bool reads() const { return false; }

 protected:
  /// \param has_value  whether there is a value to write
  /// \return whether the member is written, read or listed
  virtual bool has(const Member& member, bool has_value) = 0;
  virtual void text(const Member& member, std::string& value) = 0;
  virtual void boolean(const Member& member, bool& value) = 0;
  virtual void number(const Member& member, double& value) = 0;
  virtual void integer(const Member& member, std::int64_t& value, std::int64_t max) = 0;
  /// Bytes, stored as hexadecimal digits.
  virtual void bytes(const Member& member, std::span<std::uint8_t> value) = 0;
  virtual void word(const Member& member, std::size_t& index,
                    std::span<const std::string_view> words) = 0;
  virtual void numbers(const Member& member, std::span<double> value) = 0;
  virtual void numbers(const Member& member, std::vector<double>& value) = 0;
  /// A list of integers, each at least the member's minimum.
  virtual void integers(const Member& member, std::vector<std::int64_t>& value,
                        std::int64_t max) = 0;
  /// A nested object, whose members `describe` lists.
  virtual void object(const Member& member, const std::function<void(BodyIo&)>& describe) = 0;

 private:
  template <typename Value>
  void visit(const Member& member, Value& value) {
    // Reading an unopened event leaves its sealed members unchanged.
    if (!member.note.sealed || has(member, true)) put(member, value);
  }
  template <typename Value>
  void visit(Member member, std::optional<Value>& value) {
    member.optional = true;
    if (!has(member, value.has_value())) return;
    if (!value) value.emplace();
    put(member, *value);
  }

  void put(const Member& member, std::string& value) { text(member, value); }
  void put(const Member& member, bool& value) { boolean(member, value); }
  void put(const Member& member, double& value) { number(member, value); }
  template <std::integral Integer>
  void put(const Member& member, Integer& value) {
    std::int64_t number = value;
    integer(member, number, std::numeric_limits<Integer>::max());
    value = static_cast<Integer>(number);
  }
  template <std::size_t size>
  void put(const Member& member, std::array<std::uint8_t, size>& value) {
    bytes(member, value);
  }
  template <std::size_t size>
  void put(const Member& member, std::array<double, size>& value) {
    numbers(member, std::span<double>(value));
  }
  void put(const Member& member, std::vector<double>& value) { numbers(member, value); }
  template <std::integral Integer>
  void put(const Member& member, std::vector<Integer>& value) {
    std::vector<std::int64_t> numbers(value.begin(), value.end());
    integers(member, numbers, std::numeric_limits<Integer>::max());
    value.resize(numbers.size());
    std::ranges::transform(numbers, value.begin(),
                           [](std::int64_t number) { return static_cast<Integer>(number); });
  }
};

}  // namespace touchtrial::record
