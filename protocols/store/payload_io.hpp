/// \file The members of an event's body in one JSON object: read strictly, written compactly.
/// Private to protocols/store: the only header here that shows nlohmann-json.
#pragma once

#include "core/errors.hpp"
#include "core/hash.hpp"
#include "core/public_keys.hpp"
#include "protocols/store/payload.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::store {

/// By enumerator.
inline constexpr std::array<std::string_view, 3> kKeptNames = {"data", "safety-record", "nothing"};

/// Takes the members of a body from one JSON object. Every function throws StoreError, naming the
/// key, if the value is missing or not what is asked for.
class BodyReader {
 public:
  /// \throws StoreError if the text is not one JSON object
  explicit BodyReader(const std::string& text)
      : object_(nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false)) {
    if (!object_.is_object()) throw StoreError("the body is not a JSON object");
  }

  void operator()(const char* key, std::string& value) const {
    const nlohmann::json& found = at(key);
    if (!found.is_string()) refuse(key, "is not a text");
    value = found.get<std::string>();
  }
  void operator()(const char* key, bool& value) const {
    const nlohmann::json& found = at(key);
    if (!found.is_boolean()) refuse(key, "is neither true nor false");
    value = found.get<bool>();
  }
  void operator()(const char* key, double& value) const {
    const nlohmann::json& found = at(key);
    if (!found.is_number()) refuse(key, "is not a number");
    value = found.get<double>();
  }
  void operator()(const char* key, Digest& value) const {
    const nlohmann::json& found = at(key);
    const std::optional<Digest> digest =
        found.is_string() ? digest_from_hex(found.get_ref<const std::string&>()) : std::nullopt;
    if (!digest) refuse(key, "is not 64 hexadecimal digits");
    value = *digest;
  }
  void operator()(const char* key, Signature& value) const {
    const nlohmann::json& found = at(key);
    const std::optional<Bytes> bytes =
        found.is_string() ? from_hex(found.get_ref<const std::string&>()) : std::nullopt;
    if (!bytes || bytes->size() != value.size()) refuse(key, "is not 128 hexadecimal digits");
    std::copy(bytes->begin(), bytes->end(), value.begin());
  }
  void operator()(const char* key, Kept& value) const {
    std::string name;
    (*this)(key, name);
    const auto* const found = std::ranges::find(kKeptNames, name);
    if (found == kKeptNames.end()) refuse(key, "is none of data, safety-record and nothing");
    value = static_cast<Kept>(found - kKeptNames.begin());
  }
  /// A whole number, at least `least`.
  void operator()(const char* key, std::int64_t& value, std::int64_t least = 0) const {
    value = whole(key, least, std::numeric_limits<std::int64_t>::max());
  }
  void operator()(const char* key, int& value, int least = 0) const {
    value = static_cast<int>(whole(key, least, std::numeric_limits<int>::max()));
  }
  /// Whole numbers from 0.
  void operator()(const char* key, std::vector<std::int64_t>& value) const {
    const nlohmann::json& found = at(key);
    if (!found.is_array()) refuse(key, "is not a list");
    for (const nlohmann::json& number : found) {
      if (!number.is_number_unsigned()) refuse(key, "holds what is no whole number from 0 on");
      value.push_back(number.get<std::int64_t>());
    }
  }
  /// Whole numbers from 1.
  void operator()(const char* key, std::vector<int>& value) const {
    std::vector<std::int64_t> numbers;
    (*this)(key, numbers);
    for (const std::int64_t number : numbers) {
      if (number < 1 || number > std::numeric_limits<int>::max()) refuse(key, "is out of range");
      value.push_back(static_cast<int>(number));
    }
  }
  /// Any of these, or nothing if the key is absent.
  template <typename Value, typename... Least>
  void operator()(const char* key, std::optional<Value>& value, Least... least) const {
    if (object_.contains(key)) (*this)(key, value.emplace(), least...);
  }
  /// Any of these, left as it is if the key is absent.
  template <typename Value, typename... Least>
  void if_any(const char* key, Value& value, Least... least) const {
    if (object_.contains(key)) (*this)(key, value, least...);
  }
  /// A member that is sealed: left as it is if the key is absent, as it is before the event is
  /// opened.
  template <typename Value>
  void sealed(const char* key, Value& value) const {
    if_any(key, value);
  }
  /// An object within this one, or nothing if the key is absent. Its errors name both keys.
  template <typename Part>
  void part(const char* key, std::optional<Part>& value) const {
    if (!object_.contains(key)) return;
    const nlohmann::json& found = at(key);
    if (!found.is_object()) refuse(key, "is not an object");
    const BodyReader within(found, place_ + "/" + key);
    members(within, value.emplace());
  }

 private:
  BodyReader(nlohmann::json object, std::string place)
      : object_(std::move(object)), place_(std::move(place)) {}

  [[noreturn]] void refuse(const char* key, const char* why) const {
    throw StoreError(place_ + "/" + key + " " + why);
  }
  [[nodiscard]] const nlohmann::json& at(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) refuse(key, "is missing");
    return *found;
  }
  [[nodiscard]] std::int64_t whole(const char* key, std::int64_t least, std::int64_t most) const {
    const nlohmann::json& found = at(key);
    // Beyond 2^63 the parser makes an unsigned number, which a cast would turn negative.
    const bool too_large =
        found.is_number_unsigned() &&
        found.get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()};
    if (!found.is_number_integer() || too_large) refuse(key, "is not a whole number");
    const auto number = found.get<std::int64_t>();
    if (number < least || number > most) refuse(key, "is out of range");
    return number;
  }

  nlohmann::json object_;
  std::string place_;  ///< JSON pointer
};

/// Puts the members of a body into one JSON object. The limits that BodyReader checks mean nothing
/// here.
class BodyWriter {
 public:
  template <typename Value>
  void operator()(const char* key, const Value& value, int /*least*/ = 0) {
    object_[key] = value;
  }
  void operator()(const char* key, const Digest& value) { object_[key] = to_hex(value); }
  void operator()(const char* key, const Signature& value) {
    object_[key] = to_hex(ByteView(value));
  }
  void operator()(const char* key, Kept value) {
    object_[key] = kKeptNames.at(static_cast<std::size_t>(value));
  }
  /// JSON has no infinities.
  void operator()(const char* key, double value) {
    if (!std::isfinite(value)) {
      throw StoreError(std::string("/") + key +
                       " to be stored is not a finite number; check the device");
    }
    object_[key] = value;
  }
  template <typename Value>
  void operator()(const char* key, const std::optional<Value>& value, int /*least*/ = 0) {
    if (value) (*this)(key, *value);
  }
  /// Leaves the key out where the value is 0 or empty.
  template <typename Value>
  void if_any(const char* key, const Value& value, int /*least*/ = 0) {
    if (value != Value{}) (*this)(key, value);
  }
  template <typename Value>
  void sealed(const char* key, const Value& value) {
    (*this)(key, value);
  }
  template <typename Part>
  void part(const char* key, const std::optional<Part>& value) {
    if (!value) return;
    BodyWriter within;
    members(within, *value);
    object_[key] = std::move(within.object_);
  }

  [[nodiscard]] const nlohmann::json& object() const noexcept { return object_; }

 private:
  nlohmann::json object_ = nlohmann::json::object();
};

}  // namespace touchtrial::store
