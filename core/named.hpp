/// \file Names of enumeration values: one table per enumeration, searched by name or by value, as
/// `std::to_array<Named<Value>>({{"word", value}, ..})`.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace touchtrial {

/// A word used in files or commands, and the value it stands for.
template <typename Value>
struct Named {
  std::string_view name;
  Value value;
};

/// \return the word for a value, the first if it has several; "unknown" if it has none
template <typename Value, std::size_t size>
[[nodiscard]] constexpr std::string_view name_in(const std::array<Named<Value>, size>& table,
                                                 Value value) noexcept {
  for (const Named<Value>& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return "unknown";
}

/// \return the value of a word; nothing for a word that is not in the table
template <typename Value, std::size_t size>
[[nodiscard]] constexpr std::optional<Value> value_in(const std::array<Named<Value>, size>& table,
                                                      std::string_view name) noexcept {
  for (const Named<Value>& entry : table) {
    if (entry.name == name) return entry.value;
  }
  return std::nullopt;
}

/// \return all words, in the order of the table
template <typename Value, std::size_t size>
[[nodiscard]] constexpr std::array<std::string_view, size> names_in(
    const std::array<Named<Value>, size>& table) noexcept {
  std::array<std::string_view, size> names;
  for (std::size_t i = 0; i < size; ++i) names[i] = table[i].name;
  return names;
}

}  // namespace touchtrial
