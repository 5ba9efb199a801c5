#include "bench/peers/gl_filters.hpp"

#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/gl_row.hpp"
#include "engine/symmetric_extension.hpp"
#include "tests/engine/reference/gl_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace touchtrial::bench {
namespace {

constexpr int kMostSide = 2 * 63 + 1;

template <typename Real>
using Mask = std::array<Real, static_cast<std::size_t>(kMostSide) * kMostSide>;

/// The mask of one order, row by row.
template <typename Real>
void make_mask(Real order, int radius, Mask<Real>& mask) {
  const int side = 2 * radius + 1;
  const auto at = [&](int dy, int dx) -> Real& {
    return mask[static_cast<std::size_t>((radius + dy) * side + radius + dx)];
  };
  for (int i = 0; i < side * side; ++i) mask[static_cast<std::size_t>(i)] = Real{0};
  Real weight = 1;
  for (int k = 1; k <= radius; ++k) {
    weight *= (static_cast<Real>(k - 1) - order) / static_cast<Real>(k);
    for (int dy = -k; dy <= k; dy += k) {
      for (int dx = -k; dx <= k; dx += k) at(dy, dx) += weight / 8;
    }
    at(0, 0) -= weight / 8 + weight;
  }
}

template <typename Real>
Real masked(const GreyImage& image, int y, int x, int radius, const Mask<Real>& mask) {
  Real sum = 0;
  std::size_t i = 0;
  for (int dy = -radius; dy <= radius; ++dy) {
    const auto row = image.row(engine::symmetric_index(y + dy, image.height()));
    for (int dx = -radius; dx <= radius; ++dx) {
      const auto column = static_cast<std::size_t>(engine::symmetric_index(x + dx, image.width()));
      sum += mask[i++] * static_cast<Real>(row[column]);
    }
  }
  return sum;
}

}  // namespace

void filter_adaptive(const GreyImage& image, int radius, const Plane<float>& orders,
                     Plane<float>& texture) {
  constexpr std::size_t kReadPast = 2 * engine::kVectorBytes / sizeof(float);
  const auto width = static_cast<std::size_t>(image.width());
  engine::AlignedRows<float> last(1, width, kReadPast);
  if (texture.size() != image.size()) texture = {image.height(), image.width()};
  engine::ExtendedRows rows(image, radius);
  for (int y = 0; y < image.height(); ++y) {
    const float* order = orders.row(y).data();
    const std::size_t end = (static_cast<std::size_t>(y) + 1) * width;
    if (end + kReadPast > orders.size()) {
      std::copy_n(order, width, last.row(0));
      order = last.row(0);
    }
    rows.next_row();
    engine::gl_row(rows, radius, order, texture.row(y).data());
  }
}

template <typename Real>
void naive_mask_texture(const GreyImage& image, const Plane<double>& orders, int radius,
                        Plane<Real>& texture) {
  Mask<Real> mask;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      make_mask(static_cast<Real>(orders.at(y, x)), radius, mask);
      texture.at(y, x) = masked(image, y, x, radius, mask);
    }
  }
}

template void naive_mask_texture(const GreyImage&, const Plane<double>&, int, Plane<float>&);
template void naive_mask_texture(const GreyImage&, const Plane<double>&, int, Plane<double>&);
template void naive_mask_texture(const GreyImage&, const Plane<double>&, int, Plane<long double>&);

cv::Mat fixed_order_mask(double order, int radius, MaskGives gives) {
  const std::vector<double> weights = reference::gl_weights(order, radius);
  cv::Mat mask = cv::Mat::zeros(2 * radius + 1, 2 * radius + 1, CV_32F);
  double centre = gives == MaskGives::enhanced ? 1.0 : 0.0;
  for (int k = 1; k <= radius; ++k) {
    const double share = std::abs(weights[static_cast<std::size_t>(k)]) / 8.0;
    centre += 8.0 * share;
    for (int dy = -k; dy <= k; dy += k) {
      for (int dx = -k; dx <= k; dx += k) {
        if (dy == 0 && dx == 0) continue;
        mask.at<float>(radius + dy, radius + dx) = static_cast<float>(-share);
      }
    }
  }
  mask.at<float>(radius, radius) = static_cast<float>(centre);
  return mask;
}

}  // namespace touchtrial::bench
