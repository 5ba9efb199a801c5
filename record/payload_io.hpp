/// \file The members of an event's body in one JSON object: read strictly, written compactly.
/// Private to record: the only header here that shows nlohmann-json.
#pragma once

#include "core/errors.hpp"
#include "core/hash.hpp"
#include "core/public_keys.hpp"
#include "record/payload.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::record {

/// By enumerator.
inline constexpr std::array<std::string_view, 3> kRetentionNames = {"data", "safety-record",
                                                                    "nothing"};

/// Reads the members of a body from one JSON object; of several with one key the last counts. Every
/// function throws StoreError, naming the key, if the value is missing or has another type or
/// range.
class BodyReader {
 public:
  /// \param more  an object whose members override those of the first; empty: none
  /// \throws StoreError if a text is not one JSON object
  explicit BodyReader(std::string_view text, std::string_view more = {}) : first_(parsed(text)) {
    if (!more.empty()) second_ = parsed(more);
  }
  BodyReader(const BodyReader&) = delete;
  BodyReader& operator=(const BodyReader&) = delete;

  void operator()(std::string_view key, std::string& value) const {
    value = text(key, "is not a text");
  }
  void operator()(std::string_view key, bool& value) const {
    const Json& found = at(key);
    if (!found.is_boolean()) refuse(key, "is neither true nor false");
    value = found.get<bool>();
  }
  void operator()(std::string_view key, double& value) const {
    const Json& found = at(key);
    if (!found.is_number()) refuse(key, "is not a number");
    value = found.get<double>();
  }
  void operator()(std::string_view key, Digest& value) const {
    constexpr const char* kWhy = "is not 64 hexadecimal digits";
    const std::optional<Digest> digest = digest_from_hex(text(key, kWhy));
    if (!digest) refuse(key, kWhy);
    value = *digest;
  }
  void operator()(std::string_view key, Signature& value) const {
    constexpr const char* kWhy = "is not 128 hexadecimal digits";
    const std::optional<Bytes> bytes = from_hex(text(key, kWhy));
    if (!bytes || bytes->size() != value.size()) refuse(key, kWhy);
    std::copy(bytes->begin(), bytes->end(), value.begin());
  }
  void operator()(std::string_view key, Retention& value) const {
    const auto* const found = std::ranges::find(kRetentionNames, text(key, "is not a text"));
    if (found == kRetentionNames.end()) refuse(key, "is not data, safety-record or nothing");
    value = static_cast<Retention>(found - kRetentionNames.begin());
  }
  /// A whole number, at least `least`.
  void operator()(std::string_view key, std::int64_t& value, std::int64_t least = 0) const {
    value = whole(key, least, std::numeric_limits<std::int64_t>::max());
  }
  void operator()(std::string_view key, int& value, int least = 0) const {
    value = static_cast<int>(whole(key, least, std::numeric_limits<int>::max()));
  }
  /// As many numbers as there are places.
  template <std::size_t size>
  void operator()(std::string_view key, std::array<double, size>& value) const {
    const Json& found = at(key);
    if (!found.is_array() || found.size() != size) {
      refuse(key, "is not a list of the right length");
    }
    for (std::size_t i = 0; i < size; ++i) {
      if (!found[i].is_number()) refuse(key, "contains something other than numbers");
      value[i] = found[i].get<double>();
    }
  }
  void operator()(std::string_view key, std::vector<double>& value) const {
    const Json& found = at(key);
    if (!found.is_array()) refuse(key, "is not a list");
    for (const Json& number : found) {
      if (!number.is_number()) refuse(key, "contains something other than numbers");
      value.push_back(number.get<double>());
    }
  }
  /// Whole numbers from 0.
  void operator()(std::string_view key, std::vector<std::int64_t>& value) const {
    const Json& found = at(key);
    if (!found.is_array()) refuse(key, "is not a list");
    for (const Json& number : found) {
      if (!number.is_number_unsigned())
        refuse(key, "contains something other than whole numbers from 0");
      value.push_back(number.get<std::int64_t>());
    }
  }
  /// Whole numbers from 1.
  void operator()(std::string_view key, std::vector<int>& value) const {
    std::vector<std::int64_t> numbers;
    (*this)(key, numbers);
    for (const std::int64_t number : numbers) {
      if (number < 1 || number > std::numeric_limits<int>::max()) refuse(key, "is out of range");
      value.push_back(static_cast<int>(number));
    }
  }
  /// Any of these types, or nothing if the key is absent.
  template <typename Value, typename... Least>
  void operator()(std::string_view key, std::optional<Value>& value, Least... least) const {
    if (find(key) != nullptr) (*this)(key, value.emplace(), least...);
  }
  /// Any of these types, unchanged if the key is absent.
  template <typename Value, typename... Least>
  void if_any(std::string_view key, Value& value, Least... least) const {
    if (find(key) != nullptr) (*this)(key, value, least...);
  }
  /// A sealed member: unchanged if the key is absent, which is so before the event is opened.
  template <typename Value>
  void sealed(std::string_view key, Value& value) const {
    if_any(key, value);
  }
  /// An object within this one, or nothing if the key is absent. Its errors name both keys.
  template <typename Part>
  void part(std::string_view key, std::optional<Part>& value) const {
    const Json* const found = find(key);
    if (found == nullptr) return;
    if (!found->is_object()) refuse(key, "is not an object");
    const BodyReader within(*this, key, *found);
    members(within, value.emplace());
  }

 private:
  using Json = nlohmann::json;

  /// An object within another one.
  BodyReader(const BodyReader& outer, std::string_view key, const Json& object)
      : first_(object), place_(outer.place_ + "/" + std::string(key)) {}

  [[nodiscard]] static Json parsed(std::string_view text) {
    Json object = Json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (!object.is_object()) throw StoreError("the body is not a JSON object");
    return object;
  }

  [[noreturn]] void refuse(std::string_view key, const char* why) const {
    throw StoreError(place_ + "/" + std::string(key) + " " + why);
  }
  /// \return null if there is none
  [[nodiscard]] const Json* find(std::string_view key) const {
    for (const Json* const object : {&second_, &first_}) {
      if (const auto found = object->find(key); found != object->end()) return &*found;
    }
    return nullptr;
  }
  [[nodiscard]] const Json& at(std::string_view key) const {
    const Json* const found = find(key);
    if (found == nullptr) refuse(key, "is missing");
    return *found;
  }
  [[nodiscard]] std::string_view text(std::string_view key, const char* otherwise) const {
    const Json& found = at(key);
    if (!found.is_string()) refuse(key, otherwise);
    return found.get_ref<const std::string&>();
  }
  [[nodiscard]] std::int64_t whole(std::string_view key, std::int64_t least,
                                   std::int64_t most) const {
    const Json& found = at(key);
    if (!found.is_number_integer()) refuse(key, "is not a whole number");
    const auto number = found.get<std::int64_t>();
    const bool is_too_large = found.is_number_unsigned() && number < 0;
    if (is_too_large || number < least || number > most) refuse(key, "is out of range");
    return number;
  }

  Json first_ = Json::object();
  Json second_ = Json::object();  ///< its members override those of the first
  std::string place_;             ///< JSON pointer
};

/// Puts the members of a body into one JSON object. The limits that BodyReader checks are ignored
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
  void operator()(const char* key, Retention value) {
    object_[key] = kRetentionNames.at(static_cast<std::size_t>(value));
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

}  // namespace touchtrial::record
