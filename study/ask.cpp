#include "study/ask.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::study {
namespace {

std::string mismatch_of_choice(const Chosen& chosen, std::size_t choices) {
  for (const std::optional<int>& position :
       {std::optional(chosen.position), chosen.first_position}) {
    if (!position || (*position >= 0 && *position < static_cast<int>(choices))) continue;
    return fmt::format("chooses position {}, but the screen has {}", *position,
                       choices == 0 ? "none" : fmt::format("0 to {}", choices - 1));
  }
  return "";
}

std::string mismatch_of_ratings(const Rated& rated, const std::vector<Scale>& scales) {
  if (rated.values.size() != scales.size()) {
    return fmt::format("has {} ratings for {} scales", rated.values.size(), scales.size());
  }
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const double value = rated.values[i];
    if (value >= scales[i].min() && value <= scales[i].max()) continue;
    return fmt::format("rates {} on scale {}, which runs from {} to {}", value, scales[i].id,
                       scales[i].min(), scales[i].max());
  }
  return "";
}

}  // namespace

std::string mismatch_of(const Answer& answer, const Ask& ask) {
  if (const auto* const chosen = std::get_if<Chosen>(&answer)) {
    return mismatch_of_choice(*chosen, ask.choices().size());
  }
  return mismatch_of_ratings(std::get<Rated>(answer), ask.scales());
}

}  // namespace touchtrial::study
