/// \file The keys that a reader of files knows, by its own error.
#pragma once

#include "support/catch.hpp"

#include <set>
#include <string>

namespace touchtrial {

/// \param message  of an error about an unknown key, which ends with "known here: a, b, c"
inline std::set<std::string> known_keys_in(const std::string& message) {
  const std::string mark = "known here: ";
  REQUIRE(message.find(mark) != std::string::npos);
  std::string list = message.substr(message.find(mark) + mark.size()) + ", ";
  std::set<std::string> keys;
  for (auto end = list.find(", "); end != std::string::npos; end = list.find(", ")) {
    keys.insert(list.substr(0, end));
    list.erase(0, end + 2);
  }
  return keys;
}

}  // namespace touchtrial
