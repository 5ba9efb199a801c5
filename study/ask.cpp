#include "study/ask.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::study {
namespace {

std::string mismatch_of_choice(const ChoiceAnswer& choice, std::size_t choices) {
  for (const std::optional<int>& position :
       {std::optional(choice.position), choice.first_position}) {
    if (!position || (*position >= 0 && *position < static_cast<int>(choices))) continue;
    return fmt::format("chooses position {}, but the screen has {}", *position,
                       choices == 0 ? "none" : fmt::format("0 to {}", choices - 1));
  }
  return "";
}

std::string mismatch_of_ratings(const RatingAnswer& rating_answer,
                                const std::vector<Scale>& scales) {
  if (rating_answer.values.size() != scales.size()) {
    return fmt::format("has {} ratings for {} scales", rating_answer.values.size(), scales.size());
  }
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const double value = rating_answer.values[i];
    if (value >= scales[i].min() && value <= scales[i].max()) continue;
    return fmt::format("rates {} on scale {}, which runs from {} to {}", value, scales[i].id,
                       scales[i].min(), scales[i].max());
  }
  return "";
}

}  // namespace

std::string mismatch_of(const Answer& answer, const TrialQuestion& question) {
  if (const auto* const choice = std::get_if<ChoiceAnswer>(&answer)) {
    return mismatch_of_choice(*choice, question.choices().size());
  }
  return mismatch_of_ratings(std::get<RatingAnswer>(answer), question.scales());
}

}  // namespace touchtrial::study
