#include "analysis/cues/answer_divergence.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace touchtrial::analysis {
namespace {

double total(std::span<const double> counts) noexcept {
  return std::accumulate(counts.begin(), counts.end(), 0.0);
}

/// Of p log2 (p / middle), which is 0 where p is.
double information(double p, double middle) noexcept {
  return p > 0.0 ? p * std::log2(p / middle) : 0.0;
}

}  // namespace

double jensen_shannon_bits(std::span<const double> a, std::span<const double> b) noexcept {
  const double all_a = total(a);
  const double all_b = total(b);
  double bits = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double p = a[i] / all_a;
    const double q = b[i] / all_b;
    const double middle = 0.5 * (p + q);
    bits += 0.5 * (information(p, middle) + information(q, middle));
  }
  // Rounding may leave the range, which is that of the divergence.
  return std::clamp(bits, 0.0, 1.0);
}

std::optional<double> answer_divergence(std::span<const double> a, std::span<const double> b,
                                        int classes) noexcept {
  const auto side = static_cast<std::size_t>(classes);
  double sum = 0.0;
  int presented = 0;
  for (std::size_t row = 0; row < side; ++row) {
    const std::span<const double> row_a = a.subspan(row * side, side);
    const std::span<const double> row_b = b.subspan(row * side, side);
    if (total(row_a) <= 0.0 || total(row_b) <= 0.0) continue;
    sum += jensen_shannon_bits(row_a, row_b);
    ++presented;
  }
  if (presented == 0) return std::nullopt;
  return sum / presented;
}

}  // namespace touchtrial::analysis
