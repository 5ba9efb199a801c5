#include "protocols/store/payload_object.hpp"

#include "core/errors.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace touchtrial::store {

std::string compact(const nlohmann::json& object) {
  try {
    return object.dump();
  } catch (const nlohmann::json::exception&) {
    throw StoreError("a text to be stored is not UTF-8; type it again without special characters");
  }
}

double finite(double value, const char* key) {
  if (!std::isfinite(value)) {
    throw StoreError(std::string("/") + key +
                     " to be stored is not a finite number; check the device");
  }
  return value;
}

PayloadObject::PayloadObject(const std::string& text)
    : object_(nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false)) {
  if (!object_.is_object()) throw StoreError("the body is not a JSON object");
}

PayloadObject::PayloadObject(nlohmann::json object, std::string place)
    : object_(std::move(object)), place_(std::move(place)) {}

void PayloadObject::refuse(const char* key, const char* why) const {
  throw StoreError(place_ + "/" + key + " " + why);
}

const nlohmann::json& PayloadObject::at(const char* key) const {
  const auto found = object_.find(key);
  if (found == object_.end()) refuse(key, "is missing");
  return *found;
}

std::string PayloadObject::text(const char* key) const {
  const nlohmann::json& value = at(key);
  if (!value.is_string()) refuse(key, "is not a text");
  return value.get<std::string>();
}

bool PayloadObject::flag(const char* key) const {
  const nlohmann::json& value = at(key);
  if (!value.is_boolean()) refuse(key, "is neither true nor false");
  return value.get<bool>();
}

double PayloadObject::number(const char* key) const {
  const nlohmann::json& value = at(key);
  if (!value.is_number()) refuse(key, "is not a number");
  return value.get<double>();
}

Digest PayloadObject::digest(const char* key) const {
  const nlohmann::json& value = at(key);
  const std::optional<Digest> digest =
      value.is_string() ? digest_from_hex(value.get_ref<const std::string&>()) : std::nullopt;
  if (!digest) refuse(key, "is not 64 hexadecimal digits");
  return *digest;
}

std::int64_t PayloadObject::integer(const char* key, std::int64_t least, std::int64_t most) const {
  const nlohmann::json& value = at(key);
  // Beyond 2^63 the parser makes an unsigned number, which a cast would turn negative.
  const bool too_large =
      value.is_number_unsigned() &&
      value.get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()};
  if (!value.is_number_integer() || too_large) refuse(key, "is not a whole number");
  const auto number = value.get<std::int64_t>();
  if (number < least || number > most) refuse(key, "is out of range");
  return number;
}

int PayloadObject::count(const char* key, int least) const {
  return static_cast<int>(integer(key, least, std::numeric_limits<int>::max()));
}

std::optional<int> PayloadObject::optional_count(const char* key, int least) const {
  if (!object_.contains(key)) return std::nullopt;
  return count(key, least);
}

std::optional<std::string> PayloadObject::optional_text(const char* key) const {
  if (!object_.contains(key)) return std::nullopt;
  return text(key);
}

std::optional<std::int64_t> PayloadObject::optional_integer(const char* key) const {
  if (!object_.contains(key)) return std::nullopt;
  return integer(key, 0, std::numeric_limits<std::int64_t>::max());
}

std::vector<std::int64_t> PayloadObject::optional_integers(const char* key) const {
  std::vector<std::int64_t> numbers;
  if (!object_.contains(key)) return numbers;
  const nlohmann::json& value = at(key);
  if (!value.is_array()) refuse(key, "is not a list");
  for (const nlohmann::json& number : value) {
    if (!number.is_number_unsigned()) refuse(key, "holds what is no whole number from 0 on");
    numbers.push_back(number.get<std::int64_t>());
  }
  return numbers;
}

std::optional<std::vector<int>> PayloadObject::optional_counts(const char* key, int least) const {
  if (!object_.contains(key)) return std::nullopt;
  std::vector<int> counts;
  for (const std::int64_t number : optional_integers(key)) {
    if (number < least || number > std::numeric_limits<int>::max()) refuse(key, "is out of range");
    counts.push_back(static_cast<int>(number));
  }
  return counts;
}

std::optional<PayloadObject> PayloadObject::optional_object(const char* key) const {
  if (!object_.contains(key)) return std::nullopt;
  const nlohmann::json& value = at(key);
  if (!value.is_object()) refuse(key, "is not an object");
  return PayloadObject(value, place_ + "/" + key);
}

}  // namespace touchtrial::store
