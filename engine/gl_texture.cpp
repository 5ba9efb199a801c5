#include "engine/gl_texture.hpp"

#include "engine/ring_differences.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial {
namespace {

/// One row of T = v (D_1 + a_2 (D_2 + a_3 (D_3 + ..))), a_k = (k - 1 - v) / k. The differences are
/// exact, and no later term is larger than the ones before it: the error does not grow with K.
template <typename Real>
void difference_row(const RingDifferences& differences, int radius, std::span<const Real> orders,
                    std::span<Real> texture) {
  const RingDifferences::Ring outermost = differences.ring(radius);
  for (std::size_t x = 0; x < texture.size(); ++x) {
    texture[x] = static_cast<Real>(outermost.at(x));
  }
  for (int k = radius - 1; k >= 1; --k) {
    const RingDifferences::Ring ring = differences.ring(k);
    const auto distance = static_cast<Real>(k);
    for (std::size_t x = 0; x < texture.size(); ++x) {
      const Real decay = (distance - orders[x]) / (distance + 1);
      texture[x] = static_cast<Real>(ring.at(x)) + decay * texture[x];
    }
  }
  for (std::size_t x = 0; x < texture.size(); ++x) {
    texture[x] *= orders[x] * (Real{1} / 8);  // the rings hold eight samples
  }
}

/// \param orders_of_row  called with y, returns that row's orders
template <typename Real, typename OrdersOfRow>
Plane<Real> texture_by_rows(const GreyImage& image, int radius, OrdersOfRow orders_of_row) {
  Plane<Real> texture(image.height(), image.width());
  RingDifferences differences(image, radius);
  for (int y = 0; y < image.height(); ++y) {
    differences.next_row();
    difference_row<Real>(differences, radius, orders_of_row(y), texture.row(y));
  }
  return texture;
}

}  // namespace

template <typename Real>
Plane<Real> gl_texture(const GreyImage& image, int radius, double order) {
  const std::vector<Real> row(static_cast<std::size_t>(image.width()), static_cast<Real>(order));
  return texture_by_rows<Real>(
      image, radius, [&](int) -> const auto& { return row; });
}

template <typename Real>
Plane<Real> gl_texture(const GreyImage& image, int radius, const Plane<double>& orders) {
  std::vector<Real> row(static_cast<std::size_t>(image.width()));
  return texture_by_rows<Real>(
      image, radius, [&](int y) -> const auto& {
        const auto from = orders.row(y / 2);
        for (std::size_t x = 0; x < row.size(); ++x) row[x] = static_cast<Real>(from[x / 2]);
        return row;
      });
}

template Plane<float> gl_texture<float>(const GreyImage&, int, double);
template Plane<double> gl_texture<double>(const GreyImage&, int, double);
template Plane<float> gl_texture<float>(const GreyImage&, int, const Plane<double>&);
template Plane<double> gl_texture<double>(const GreyImage&, int, const Plane<double>&);

}  // namespace touchtrial
