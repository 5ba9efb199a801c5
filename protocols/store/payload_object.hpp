/// \file Strict reading of one JSON object, and its compact form with sorted keys.
/// Private to protocols/store: the only header here that shows nlohmann-json.
#pragma once

#include "core/hash.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::store {

/// \throws StoreError if a text in it is not UTF-8
[[nodiscard]] std::string compact(const nlohmann::json& object);

/// JSON has no infinities. \return `value` \throws StoreError naming `key` if it is not finite
[[nodiscard]] double finite(double value, const char* key);

/// A parsed object whose members are asked for by key and type. Every member function throws
/// StoreError, naming the key, if the value is missing or not what is asked for.
class PayloadObject {
 public:
  /// \throws StoreError if the text is not one JSON object
  explicit PayloadObject(const std::string& text);

  [[nodiscard]] std::string text(const char* key) const;
  [[nodiscard]] bool flag(const char* key) const;
  [[nodiscard]] double number(const char* key) const;
  [[nodiscard]] Digest digest(const char* key) const;
  /// A whole number in [least, most].
  [[nodiscard]] std::int64_t integer(const char* key, std::int64_t least, std::int64_t most) const;
  /// A whole number in [least, largest int].
  [[nodiscard]] int count(const char* key, int least) const;
  /// The same, or nothing if the key is absent.
  [[nodiscard]] std::optional<int> optional_count(const char* key, int least) const;
  [[nodiscard]] std::optional<std::string> optional_text(const char* key) const;
  [[nodiscard]] std::optional<std::int64_t> optional_integer(const char* key) const;
  /// Whole numbers >= 0, or none if the key is absent.
  [[nodiscard]] std::vector<std::int64_t> optional_integers(const char* key) const;
  /// Whole numbers in [least, largest int], or nothing if the key is absent.
  [[nodiscard]] std::optional<std::vector<int>> optional_counts(const char* key, int least) const;
  /// An object within this one, or nothing if the key is absent. Its errors name both keys.
  [[nodiscard]] std::optional<PayloadObject> optional_object(const char* key) const;

 private:
  PayloadObject(nlohmann::json object, std::string place);
  [[nodiscard]] const nlohmann::json& at(const char* key) const;
  [[noreturn]] void refuse(const char* key, const char* why) const;

  nlohmann::json object_;
  std::string place_;  ///< JSON pointer
};

}  // namespace touchtrial::store
