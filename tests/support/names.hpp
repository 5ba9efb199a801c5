/// \file What a message names, whatever its words: files, JSON pointers, options, keys, numbers.
#pragma once

#include "support/catch.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace touchtrial {

/// Whether `message` names each of `places`, which blanks separate, in any order. A place that
/// begins or ends with a letter or digit is not part of a longer word or number.
[[nodiscard]] inline bool names(const std::string& message, const std::string& places) {
  const auto is_part = [&](std::size_t at) {
    return at < message.size() && std::isalnum(static_cast<unsigned char>(message[at])) != 0;
  };
  const auto is_named = [&](const std::string& place) {
    const bool from_part = std::isalnum(static_cast<unsigned char>(place.front())) != 0;
    const bool to_part = std::isalnum(static_cast<unsigned char>(place.back())) != 0;
    for (auto at = message.find(place); at != std::string::npos; at = message.find(place, at + 1)) {
      const bool is_whole =
          !(from_part && is_part(at - 1)) && !(to_part && is_part(at + place.size()));
      if (is_whole) return true;
    }
    return false;
  };
  std::istringstream list(places);
  const std::vector<std::string> all{std::istream_iterator<std::string>(list), {}};
  return !all.empty() && std::ranges::all_of(all, is_named);
}

/// A matcher for messages that name each of `places`, which blanks separate.
class NamesPlaces final : public
#if __has_include(<catch2/catch_all.hpp>)
                          Catch::Matchers::MatcherBase<std::string>
#else
                          Catch::MatcherBase<std::string>
#endif
{
 public:
  explicit NamesPlaces(std::string places) : places_(std::move(places)) {}

  bool match(const std::string& message) const override {
    return names(message, places_);
  }
  std::string describe() const override {
    return "names: " + places_;
  }

 private:
  std::string places_;
};

/// \see NamesPlaces
[[nodiscard]] inline NamesPlaces names(const std::string& places) {
  return NamesPlaces(places);
}

}  // namespace touchtrial
