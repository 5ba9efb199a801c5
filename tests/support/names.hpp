/// \file Asserts the files, JSON pointers, options, keys and numbers in a message, not its words.
#pragma once

#include "support/catch.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace touchtrial {

/// \return the position of `place` in `message` at or after `from`, else npos. A place that begins or
///   ends with a letter or digit must not be part of a longer word or number.
[[nodiscard]] inline std::size_t find_place(const std::string& message, const std::string& place,
                                            std::size_t from = 0) {
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (auto at = message.find(place, from); at != std::string::npos;
       at = message.find(place, at + 1)) {
    const std::size_t end = at + place.size();
    const bool is_cut_before = at > 0 && is_part(place.front()) && is_part(message[at - 1]);
    const bool is_cut_after =
        end < message.size() && is_part(place.back()) && is_part(message[end]);
    if (!is_cut_before && !is_cut_after) return at;
  }
  return std::string::npos;
}

/// Splits `places` at blanks.
[[nodiscard]] inline std::vector<std::string> separate_places(const std::string& places) {
  std::istringstream list(places);
  return {std::istream_iterator<std::string>(list), {}};
}

/// Whether `message` contains each of the blank-separated `places`, in any order.
[[nodiscard]] inline bool names(const std::string& message, const std::string& places) {
  const auto all = separate_places(places);
  return !all.empty() && std::ranges::all_of(all, [&](const std::string& place) {
    return find_place(message, place) != std::string::npos;
  });
}

/// Whether `message` contains `places` in this order, for numbers that only their order identifies.
[[nodiscard]] inline bool names_in_order(const std::string& message, const std::string& places) {
  const auto all = separate_places(places);
  std::size_t from = 0;
  return !all.empty() && std::ranges::all_of(all, [&](const std::string& place) {
    const std::size_t at = find_place(message, place, from);
    from = at + place.size();
    return at != std::string::npos;
  });
}

/// A matcher for messages that contain each of the blank-separated `places`.
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
