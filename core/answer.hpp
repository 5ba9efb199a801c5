/// \file A participant's answer to a trial.
#pragma once

#include <optional>
#include <variant>
#include <vector>

namespace touchtrial {

/// A choice among several alternatives.
struct ChoiceAnswer {
  int position = 0;                     ///< in the participant's layout, from 0
  std::optional<int> first_position{};  ///< the choice before a change

  friend bool operator==(const ChoiceAnswer&, const ChoiceAnswer&) = default;
};

/// One number per rating scale.
struct RatingAnswer {
  std::vector<double> values;  ///< in the order of the scales, at least one

  friend bool operator==(const RatingAnswer&, const RatingAnswer&) = default;
};

using Answer = std::variant<ChoiceAnswer, RatingAnswer>;

/// \return nothing if there is no answer or it is not a choice
[[nodiscard]] inline std::optional<int> position_of(const std::optional<Answer>& answer) {
  const auto* const choice = answer ? std::get_if<ChoiceAnswer>(&*answer) : nullptr;
  return choice == nullptr ? std::nullopt : std::optional(choice->position);
}

/// \return nothing if there is no answer, it is not a choice, or it was not changed
[[nodiscard]] inline std::optional<int> first_position_of(const std::optional<Answer>& answer) {
  const auto* const choice = answer ? std::get_if<ChoiceAnswer>(&*answer) : nullptr;
  return choice == nullptr ? std::nullopt : choice->first_position;
}

/// \return nothing if there is no answer or it is not a rating
[[nodiscard]] inline std::vector<double> ratings_of(const std::optional<Answer>& answer) {
  const auto* const rating = answer ? std::get_if<RatingAnswer>(&*answer) : nullptr;
  return rating == nullptr ? std::vector<double>() : rating->values;
}

}  // namespace touchtrial
