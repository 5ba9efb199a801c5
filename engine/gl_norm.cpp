#include "engine/gl_norm.hpp"

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

double mean_of(const GreyImage& image) {
  const auto samples = image.samples();
  const std::int64_t sum = std::accumulate(samples.begin(), samples.end(), std::int64_t{0});
  return static_cast<double>(sum) / static_cast<double>(samples.size());
}

/// \param weight_sum  called with y and x, returns S_K of the pixel's order
template <typename WeightSum>
void apply(Norm norm, const GreyImage& image, Plane<double>& texture, WeightSum weight_sum) {
  if (norm == Norm::additive) return;
  const double mean = norm == Norm::none ? mean_of(image) : 0.0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      double& sample = texture.at(y, x);
      if (norm == Norm::sum) sample /= weight_sum(y, x);
      if (norm == Norm::none) sample += weight_sum(y, x) * (image.at(y, x) - mean);
    }
  }
}

}  // namespace

double gl_weight_sum(double order, int radius) {
  if (!(order >= 0.0 && order < 1.0)) {
    throw std::invalid_argument("order: must be in [0, 1)");
  }
  if (radius < 1) throw std::invalid_argument("radius: must be at least 1");
  double product = 1.0;
  for (int k = 1; k <= radius; ++k) product *= 1.0 - order / k;
  return product;
}

void apply_norm(Norm norm, const GreyImage& image, int radius, double order,
                Plane<double>& texture) {
  const double sum = gl_weight_sum(order, radius);
  apply(norm, image, texture, [sum](int, int) { return sum; });
}

void apply_norm(Norm norm, const GreyImage& image, int radius, const Plane<double>& orders,
                Plane<double>& texture) {
  Plane<double> sums = orders;
  if (norm != Norm::additive) {
    for (double& sample : sums.samples()) sample = gl_weight_sum(sample, radius);
  }
  apply(norm, image, texture, [&sums](int y, int x) { return sums.at(y / 2, x / 2); });
}

}  // namespace touchtrial::engine
