#include "engine/reference/glcm_reference.hpp"

#include <cmath>

namespace touchtrial::reference {
namespace {

constexpr int kLevels = 256;

Plane<double> probabilities(const GreyImage& image, int dy, int dx) {
  Plane<double> counts(kLevels, kLevels);
  double total = 0.0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (y + dy < 0 || y + dy >= image.height() || x + dx < 0 || x + dx >= image.width()) continue;
      const int i = image.at(y, x);
      const int j = image.at(y + dy, x + dx);
      counts.at(i, j) += 1.0;
      counts.at(j, i) += 1.0;
      total += 2.0;
    }
  }
  for (double& count : counts.samples()) count /= total;
  return counts;
}

/// Sum over i and j of term(i, j, p).
template <typename Term>
double sum_over(const Plane<double>& p, Term&& term) {
  double sum = 0.0;
  for (int i = 0; i < kLevels; ++i) {
    for (int j = 0; j < kLevels; ++j) {
      if (p.at(i, j) > 0.0) sum += term(i, j, p.at(i, j));
    }
  }
  return sum;
}

double correlation(const Plane<double>& p) {
  const double mean_i = sum_over(p, [](int i, int, double q) { return i * q; });
  const double mean_j = sum_over(p, [](int, int j, double q) { return j * q; });
  const auto product = [&](double i, double j) { return (i - mean_i) * (j - mean_j); };
  const double variance_i =
      sum_over(p, [&](int i, int, double q) { return (i - mean_i) * (i - mean_i) * q; });
  const double variance_j =
      sum_over(p, [&](int, int j, double q) { return (j - mean_j) * (j - mean_j) * q; });
  if (variance_i < 1e-12 || variance_j < 1e-12) return 1.0;
  return sum_over(p, [&](int i, int j, double q) { return product(i, j) * q; }) /
         std::sqrt(variance_i * variance_j);
}

}  // namespace

engine::GlcmStatistics glcm_statistics(const GreyImage& image, int dy, int dx) {
  const Plane<double> p = probabilities(image, dy, dx);
  engine::GlcmStatistics result{};
  result.angular_second_moment = sum_over(p, [](int, int, double q) { return q * q; });
  result.energy = std::sqrt(result.angular_second_moment);
  result.entropy = sum_over(p, [](int, int, double q) { return -q * std::log(q); });
  result.contrast = sum_over(p, [](int i, int j, double q) { return (i - j) * (i - j) * q; });
  result.correlation = correlation(p);
  return result;
}

}  // namespace touchtrial::reference
