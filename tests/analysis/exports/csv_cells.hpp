/// \file What single cells of exported CSV files say. Fails the test if they say something else.
#pragma once

#include "support/catch.hpp"

#include <charconv>
#include <map>
#include <optional>
#include <string>

namespace touchtrial {

/// A row's cells by the names of the header.
using CsvRow = std::map<std::string, std::string>;

template <typename Number>
[[nodiscard]] Number number_of(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  REQUIRE(error == std::errc{});
  REQUIRE(end == text.data() + text.size());
  return value;
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
