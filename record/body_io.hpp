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

/// What is known of a member beside its type and meaning. Units are in the names of keys.
struct MemberNote {
  std::int64_t min = 0;  ///< of a whole number
  bool sealed = false;   ///< absent while the event is not opened
};

/// One visitor of a body: its writer, its reader, or a listing of its members. There are no
/// defaults: a member is required unless it is optional by its type or by if_any() and unless().
/// All functions throw StoreError, naming the key.
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
  /// Without the key where the value is 0, false or empty.
  template <typename Value>
  void if_any(std::string_view key, Value& value, std::string_view meaning,
              const MemberNote& note = {}) {
    unless(Value{}, key, value, meaning, note);
  }
  /// Without the key where the value is `usual`.
  template <typename Value>
  void unless(const Value& default_value, std::string_view key, Value& value,
              std::string_view meaning, const MemberNote& note = {}) {
    const Member member{key, meaning, note, /*optional=*/true};
    if (has(member, value != default_value)) put(member, value);
  }
  /// One of the words of an enumeration, in the order of its enumerators.
  template <typename Value, std::size_t size>
  void choice(std::string_view key, Value& value, const std::array<std::string_view, size>& words,
              std::string_view meaning) {
    auto at = static_cast<std::size_t>(value);
    word({key, meaning}, at, words);
    value = static_cast<Value>(at);
  }
  /// An object within this one, or nothing.
  template <typename Part>
  void part(std::string_view key, std::optional<Part>& value, std::string_view meaning) {
    const Member member{key, meaning, {}, /*optional=*/true};
    if (!has(member, value.has_value())) return;
    if (!value) value.emplace();
    within(member, [&](BodyIo& io) { value->describe(io); });
  }

  /// Whether values are taken from a body; only then can they break a rule.
  [[nodiscard]] virtual bool reads() const { return false; }

 protected:
  /// \param there  whether the value says something
  /// \return whether the member is written, read or listed
  virtual bool has(const Member& member, bool there) = 0;
  virtual void text(const Member& member, std::string& value) = 0;
  virtual void boolean(const Member& member, bool& value) = 0;
  virtual void number(const Member& member, double& value) = 0;
  virtual void whole(const Member& member, std::int64_t& value, std::int64_t max) = 0;
  /// Bytes as hexadecimal digits.
  virtual void bytes(const Member& member, std::span<std::uint8_t> value) = 0;
  virtual void word(const Member& member, std::size_t& at,
                    std::span<const std::string_view> words) = 0;
  virtual void numbers(const Member& member, std::span<double> value) = 0;
  virtual void numbers(const Member& member, std::vector<double>& value) = 0;
  /// From the member's minimum.
  virtual void wholes(const Member& member, std::vector<std::int64_t>& value, std::int64_t max) = 0;
  /// The members of an object.
  virtual void within(const Member& member, const std::function<void(BodyIo&)>& describe) = 0;

 private:
  template <typename Value>
  void visit(const Member& member, Value& value) {
    // Sealed members of an event that is not opened keep their value.
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
  template <std::integral Whole>
  void put(const Member& member, Whole& value) {
    std::int64_t number = value;
    whole(member, number, std::numeric_limits<Whole>::max());
    value = static_cast<Whole>(number);
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
  template <std::integral Whole>
  void put(const Member& member, std::vector<Whole>& value) {
    std::vector<std::int64_t> numbers(value.begin(), value.end());
    wholes(member, numbers, std::numeric_limits<Whole>::max());
    value.resize(numbers.size());
    std::ranges::transform(numbers, value.begin(),
                           [](std::int64_t number) { return static_cast<Whole>(number); });
  }
};

}  // namespace touchtrial::record
