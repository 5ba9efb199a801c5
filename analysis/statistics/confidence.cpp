#include "analysis/statistics/confidence.hpp"

#include <cstdint>
#include <map>
#include <utility>

namespace touchtrial::analysis {

std::optional<double> type_2_area(std::span<const RatedAnswer> answers) {
  std::map<int, std::pair<std::int64_t, std::int64_t>> by_rating;  // right, wrong
  for (const RatedAnswer& one : answers) {
    auto& [right, wrong] = by_rating[one.rating];
    ++(one.correct ? right : wrong);
  }
  std::int64_t all_right = 0;
  std::int64_t lower_wrong = 0;
  std::int64_t twice_won = 0;
  for (const auto& [rating, counts] : by_rating) {
    const auto& [right, wrong] = counts;
    twice_won += right * (2 * lower_wrong + wrong);
    all_right += right;
    lower_wrong += wrong;
  }
  if (all_right == 0 || lower_wrong == 0) return std::nullopt;
  return 0.5 * static_cast<double>(twice_won) / static_cast<double>(all_right * lower_wrong);
}

}  // namespace touchtrial::analysis
