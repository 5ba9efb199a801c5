#include "engine/gaussian_filter.hpp"

#include "engine/finite_plane.hpp"
#include "engine/kernels/strips.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

constexpr double kMinWeight = 1e-12;  // relative to the central weight

/// The mirrored axis has period 2n. With a standard deviation of 3n or more, the Gaussian wrapped
/// around that period is uniform to 1e-19, so a larger sigma would only cost time.
double effective_sigma(double sigma_px, int n) {
  return std::min(sigma_px, 3.0 * n);
}

/// w_0 .. w_r of a symmetric kernel with w_0 + 2 (w_1 + .. + w_r) = 1; sigma > 0.
std::vector<double> half_kernel(double sigma_px) {
  const auto radius = static_cast<int>(sigma_px * std::sqrt(-2.0 * std::log(kMinWeight)));
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

/// Adds one pair of taps. The kernel's sum is 1, so it can be applied to the differences from the
/// middle sample, which are exactly 0 where the plane is flat.
template <typename Sample>
void add_pair(std::span<double> out, const Sample* middle, const Sample* previous,
              const Sample* next, double weight) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] += weight * ((previous[i] - middle[i]) + (next[i] - middle[i]));
  }
}

}  // namespace

template <typename Sample>
GaussianRows<Sample>::GaussianRows(const Plane<Sample>& plane, double sigma_px)
    : plane_(plane),
      weights_y_(half_kernel(effective_sigma(sigma_px, plane.height()))),
      weights_x_(half_kernel(effective_sigma(sigma_px, plane.width()))),
      extended_(static_cast<std::size_t>(plane.width()) + 2 * weights_x_.size() - 2),
      filtered_(static_cast<std::size_t>(plane.width())) {}

template <typename Sample>
std::span<const double> GaussianRows<Sample>::row(int y) {
  filter_along_y(y);
  filter_along_x();
  return filtered_;
}

template <typename Sample>
void GaussianRows<Sample>::filter_along_y(int y) {
  const int height = plane_.height();
  const auto middle = plane_.row(y);
  const std::span<double> out(extended_.data() + weights_x_.size() - 1, middle.size());
  std::copy(middle.begin(), middle.end(), out.begin());
  for (int k = 1; k < static_cast<int>(weights_y_.size()); ++k) {
    add_pair(out, middle.data(), plane_.row(symmetric_index(y - k, height)).data(),
             plane_.row(symmetric_index(y + k, height)).data(),
             weights_y_[static_cast<std::size_t>(k)]);
  }
}

template <typename Sample>
void GaussianRows<Sample>::filter_along_x() {
  const int width = plane_.width();
  const auto radius = static_cast<int>(weights_x_.size()) - 1;
  double* const middle = extended_.data() + radius;
  mirror_ends(middle, width, radius);
  std::copy_n(middle, width, filtered_.begin());
  for (int k = 1; k <= radius; ++k) {
    add_pair<double>(filtered_, middle, middle - k, middle + k,
                     weights_x_[static_cast<std::size_t>(k)]);
  }
}

template class GaussianRows<std::uint8_t>;
template class GaussianRows<double>;

Plane<double> gaussian_filtered(const Plane<double>& plane, double sigma_px) {
  if (plane.empty()) throw std::invalid_argument("gaussian_filtered: the plane is empty");
  if (!(sigma_px >= 0.0)) {
    throw std::invalid_argument("gaussian_filtered: sigma must be a number >= 0");
  }
  require_finite(plane, "gaussian_filtered", "plane");
  if (sigma_px == 0.0) return plane;
  Plane<double> out(plane.height(), plane.width());
  for_each_strip(plane.height(), plane.width(), [&](Rows strip) {
    GaussianRows rows(plane, sigma_px);
    for (int y = strip.first; y < strip.last; ++y) {
      std::ranges::copy(rows.row(y), out.row(y).begin());
    }
  });
  return out;
}

}  // namespace touchtrial::engine
