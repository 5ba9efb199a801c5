/// \file Reads single cells of exported CSV files. Fails the test if a cell has no valid value.
#pragma once

#include "core/text.hpp"
#include "support/catch.hpp"

#include <map>
#include <optional>
#include <string>

namespace touchtrial {

/// A row's cells by the names of the header.
using CsvRow = std::map<std::string, std::string>;

template <typename Number>
[[nodiscard]] Number number_of(const std::string& text) {
  const auto value = number_in<Number>(text);
  REQUIRE(value.has_value());
  return *value;
}

template <typename Number>
[[nodiscard]] std::optional<Number> maybe(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return number_of<Number>(text);
}

[[nodiscard]] inline bool is_set(const std::string& text) {
  REQUIRE((text == "0" || text == "1"));
  return text == "1";
}

}  // namespace touchtrial
