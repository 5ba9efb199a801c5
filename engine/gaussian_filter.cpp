#include "engine/gaussian_filter.hpp"

#include "engine/finite_plane.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

constexpr double kSmallestWeight = 1e-12;  // relative to the middle one

/// The mirrored axis has period 2n, and from a standard deviation of 3n on the Gaussian wrapped
/// round that period is uniform to 1e-19: a wider one would only cost time.
double effective_sigma(double sigma_px, int n) {
  return std::min(sigma_px, 3.0 * n);
}

/// w_0 .. w_r of a symmetric kernel with w_0 + 2 (w_1 + .. + w_r) = 1; sigma > 0.
std::vector<double> half_kernel(double sigma_px) {
  const auto radius = static_cast<int>(sigma_px * std::sqrt(-2.0 * std::log(kSmallestWeight)));
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = 0; k <= radius; ++k) {
    const double u = k / sigma_px;
    weights.push_back(std::exp(-0.5 * u * u));
    sum += k == 0 ? weights.back() : 2.0 * weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Adds one pair of taps. The kernel's sum is 1, so it may be applied to the differences from the
/// middle sample, which are exactly zero where the plane is flat.
void add_pair(std::span<double> out, const double* middle, const double* before,
              const double* after, double weight) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] += weight * ((before[i] - middle[i]) + (after[i] - middle[i]));
  }
}

Plane<double> filtered_along_y(const Plane<double>& plane, double sigma_px) {
  const int height = plane.height();
  const std::vector<double> weights = half_kernel(effective_sigma(sigma_px, height));
  Plane<double> out = plane;
  for (int y = 0; y < height; ++y) {
    for (int k = 1; k < static_cast<int>(weights.size()); ++k) {
      const double* before = plane.row(symmetric_index(y - k, height)).data();
      const double* after = plane.row(symmetric_index(y + k, height)).data();
      add_pair(out.row(y), plane.row(y).data(), before, after, weights[k]);
    }
  }
  return out;
}

Plane<double> filtered_along_x(const Plane<double>& plane, double sigma_px) {
  const int width = plane.width();
  const std::vector<double> weights = half_kernel(effective_sigma(sigma_px, width));
  const int radius = static_cast<int>(weights.size()) - 1;
  std::vector<double> extended(static_cast<std::size_t>(width) + 2 * weights.size() - 2);
  Plane<double> out = plane;
  for (int y = 0; y < plane.height(); ++y) {
    for (int i = 0; i < static_cast<int>(extended.size()); ++i) {
      extended[i] = plane.at(y, symmetric_index(i - radius, width));
    }
    const double* middle = extended.data() + radius;
    for (int k = 1; k <= radius; ++k) {
      add_pair(out.row(y), middle, middle - k, middle + k, weights[k]);
    }
  }
  return out;
}

}  // namespace

Plane<double> gaussian_filtered(const Plane<double>& plane, double sigma_px) {
  if (plane.empty()) throw std::invalid_argument("gaussian_filtered: the plane is empty");
  if (!(sigma_px >= 0.0)) {
    throw std::invalid_argument("gaussian_filtered: sigma must be a number >= 0");
  }
  require_finite(plane, "gaussian_filtered", "plane");
  if (sigma_px == 0.0) return plane;
  return filtered_along_x(filtered_along_y(plane, sigma_px), sigma_px);
}

}  // namespace touchtrial
