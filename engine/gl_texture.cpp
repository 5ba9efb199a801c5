#include "engine/gl_texture.hpp"

#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/extended_rows.hpp"
#include "engine/kernels/gl_row.hpp"
#include "engine/ring_differences.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {
namespace {

/// One row of T = v (D_1 + a_2 (D_2 + a_3 (D_3 + ..))), a_k = (k - 1 - v) / k. The differences are
/// exact, and no later term is larger than the ones before it: the error does not grow with K.
void double_row(const ExtendedRows& rows, int radius, std::span<const double> orders,
                std::span<double> texture) {
  const RingDifferences outermost(rows, radius);
  for (std::size_t x = 0; x < texture.size(); ++x) texture[x] = outermost.at(x);
  for (int k = radius - 1; k >= 1; --k) {
    const RingDifferences ring(rows, k);
    for (std::size_t x = 0; x < texture.size(); ++x) {
      const double decay = (k - orders[x]) / (k + 1);
      texture[x] = ring.at(x) + decay * texture[x];
    }
  }
  for (std::size_t x = 0; x < texture.size(); ++x) {
    texture[x] *= orders[x] / 8;  // the rings hold eight samples
  }
}

void row_of(const ExtendedRows& rows, int radius, std::span<const double> orders,
            std::span<double> texture) {
  double_row(rows, radius, orders, texture);
}
void row_of(const ExtendedRows& rows, int radius, std::span<const float> orders,
            std::span<float> texture) {
  gl_row(rows, radius, orders.data(), texture.data());
}

/// \param orders_of_row  called with y, returns that row's orders, with a vector of slack
template <typename Real, typename OrdersOfRow>
Plane<Real> texture_by_rows(const GreyImage& image, int radius, OrdersOfRow orders_of_row) {
  Plane<Real> texture(image.height(), image.width());
  ExtendedRows rows(image, radius);
  for (int y = 0; y < image.height(); ++y) {
    rows.next_row();
    row_of(rows, radius, orders_of_row(y), texture.row(y));
  }
  return texture;
}

}  // namespace

template <>
Plane<double> gl_texture<double>(const GreyImage& image, int radius, double order) {
  const std::vector<double> row(static_cast<std::size_t>(image.width()), order);
  return texture_by_rows<double>(image, radius, [&](int) { return std::span<const double>(row); });
}

template <>
Plane<float> gl_texture<float>(const GreyImage& image, int radius, double order) {
  Plane<float> texture(image.height(), image.width());
  ExtendedRows rows(image, radius);
  for (int y = 0; y < image.height(); ++y) {
    rows.next_row();
    gl_row(rows, radius, order, texture.row(y).data());
  }
  return texture;
}

template <typename Real>
Plane<Real> gl_texture(const GreyImage& image, int radius, const Plane<double>& orders) {
  const auto width = static_cast<std::size_t>(image.width());
  AlignedRows<Real> row(1, width, 0);
  const std::span<Real> to(row.row(0), width);
  return texture_by_rows<Real>(image, radius, [&](int y) {
    const auto from = orders.row(y / 2);
    for (std::size_t x = 0; x < width; ++x) to[x] = static_cast<Real>(from[x / 2]);
    return std::span<const Real>(to);
  });
}

template Plane<float> gl_texture<float>(const GreyImage&, int, const Plane<double>&);
template Plane<double> gl_texture<double>(const GreyImage&, int, const Plane<double>&);

}  // namespace touchtrial::engine
