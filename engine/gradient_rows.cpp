#include "engine/gradient_rows.hpp"

#include "engine/symmetric_extension.hpp"

#include <cmath>
#include <cstdint>

namespace touchtrial::engine {
namespace {

void mirror_ends(std::vector<double>& framed) {
  framed.front() = framed[1];
  framed.back() = framed[framed.size() - 2];
}

}  // namespace

template <typename Sample>
GradientRows<Sample>::GradientRows(const Plane<Sample>& plane, Gradient gradient)
    : plane_(plane),
      gradient_(gradient),
      smooth_(static_cast<std::size_t>(plane.width()) + 2),
      slope_(smooth_.size()),
      norms_(static_cast<std::size_t>(plane.width())) {}

template <typename Sample>
void GradientRows<Sample>::filter_columns(int y) {
  const auto above = plane_.row(symmetric_index(y - 1, plane_.height()));
  const auto here = plane_.row(y);
  const auto below = plane_.row(symmetric_index(y + 1, plane_.height()));
  const double weight = gradient_ == Gradient::sobel ? 2.0 : 1.0;
  for (int x = 0; x < plane_.width(); ++x) {
    smooth(x) = gradient_ == Gradient::central ? here[x] : above[x] + weight * here[x] + below[x];
    slope(x) = below[x] - above[x];
  }
  mirror_ends(smooth_);
  mirror_ends(slope_);
}

template <typename Sample>
std::span<const double> GradientRows<Sample>::row(int y) {
  filter_columns(y);
  const double weight = gradient_ == Gradient::sobel ? 2.0 : 1.0;
  for (int x = 0; x < plane_.width(); ++x) {
    double gx = smooth(x + 1) - smooth(x - 1);
    double gy = slope(x - 1) + weight * slope(x) + slope(x + 1);
    if (gradient_ == Gradient::central) {
      gx *= 0.5;
      gy = 0.5 * slope(x);
    }
    norms_[static_cast<std::size_t>(x)] = std::sqrt(gx * gx + gy * gy);
  }
  return norms_;
}

template class GradientRows<std::uint8_t>;
template class GradientRows<double>;

}  // namespace touchtrial::engine
