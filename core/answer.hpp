/// \file What a participant answers, from the screen to the exports.
#pragma once

#include <optional>
#include <variant>
#include <vector>

namespace touchtrial {

/// One of several alternatives.
struct Chosen {
  int position = 0;                     ///< in the participant's layout, from 0
  std::optional<int> first_position{};  ///< the choice before a change

  friend bool operator==(const Chosen&, const Chosen&) = default;
};

/// A number on each of one or several scales.
struct Rated {
  std::vector<double> values;  ///< in the order of the scales, >= 1 of them

  friend bool operator==(const Rated&, const Rated&) = default;
};

using Answer = std::variant<Chosen, Rated>;

/// \return nothing if there is no answer or it is not a choice
[[nodiscard]] inline std::optional<int> position_of(const std::optional<Answer>& answer) {
  const auto* const chosen = answer ? std::get_if<Chosen>(&*answer) : nullptr;
  return chosen == nullptr ? std::nullopt : std::optional(chosen->position);
}

/// \return nothing if there is no answer, it is not a choice, or it was not changed
[[nodiscard]] inline std::optional<int> first_position_of(const std::optional<Answer>& answer) {
  const auto* const chosen = answer ? std::get_if<Chosen>(&*answer) : nullptr;
  return chosen == nullptr ? std::nullopt : chosen->first_position;
}

/// \return nothing if there is no answer or it is not a rating
[[nodiscard]] inline std::vector<double> ratings_of(const std::optional<Answer>& answer) {
  const auto* const rated = answer ? std::get_if<Rated>(&*answer) : nullptr;
  return rated == nullptr ? std::vector<double>() : rated->values;
}

}  // namespace touchtrial
