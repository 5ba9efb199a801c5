#include "analysis/statistics/holm.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace touchtrial::analysis {

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  for (const double p : p_values) {
    if (!(p >= 0.0 && p <= 1.0)) throw std::invalid_argument("a p lies between 0 and 1");
  }
  std::vector<std::size_t> rising(p_values.size());
  std::iota(rising.begin(), rising.end(), std::size_t{0});
  std::sort(rising.begin(), rising.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double so_far = 0.0;
  for (std::size_t rank = 0; rank < rising.size(); ++rank) {
    const auto hypotheses_left = static_cast<double>(rising.size() - rank);
    so_far = std::max(so_far, std::min(1.0, hypotheses_left * p_values[rising[rank]]));
    adjusted[rising[rank]] = so_far;
  }
  return adjusted;
}

}  // namespace touchtrial::analysis
