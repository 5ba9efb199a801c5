/// \file Counting for the tests of orders.
#pragma once

#include <map>

namespace touchtrial {

/// Pearson's statistic against equal frequencies over `cells` cells of which `counts` holds those
/// that occurred.
template <typename Key>
[[nodiscard]] double chi_square_uniform(const std::map<Key, int>& counts, int cells) {
  double total = 0.0;
  for (const auto& [key, count] : counts) total += count;
  const double expected = total / cells;
  double statistic = expected * (cells - static_cast<int>(counts.size()));
  for (const auto& [key, count] : counts) {
    statistic += (count - expected) * (count - expected) / expected;
  }
  return statistic;
}

}  // namespace touchtrial
