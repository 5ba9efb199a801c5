#include "bench/peers/naive_mask.hpp"

#include "engine/symmetric_extension.hpp"

#include <array>
#include <cstddef>

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

}  // namespace touchtrial::bench
