#include "engine/gl_texture.hpp"

#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/gl_row.hpp"
#include "engine/kernels/strips.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace touchtrial::engine {
namespace {

/// Exact differences between a row's pixels and their rings of eight samples at distance k: 8 D_k =
/// 8 I - (sum of the samples at (+-k, 0), (0, +-k) and (+-k, +-k)), a whole number of at most 2040
/// in magnitude.
class RingDifferences {
 public:
  /// \param rows  reach >= k; must not move while this object is used
  /// \param k  >= 1
  RingDifferences(const ExtendedRows& rows, int k) noexcept
      : above_(rows.row(-k)), centre_(rows.row(0)), below_(rows.row(k)), k_(k) {}

  /// \param column  0 .. width - 1
  [[nodiscard]] int at(std::size_t column) const noexcept {
    const auto x = static_cast<std::ptrdiff_t>(column);
    return 8 * centre_[x] - (above_[x - k_] + above_[x] + above_[x + k_] + centre_[x - k_] +
                             centre_[x + k_] + below_[x - k_] + below_[x] + below_[x + k_]);
  }

 private:
  const std::int16_t* above_;
  const std::int16_t* centre_;
  const std::int16_t* below_;
  std::ptrdiff_t k_;
};

/// Computes one row of T = v (D_1 + a_2 (D_2 + a_3 (D_3 + ..))), a_k = (k - 1 - v) / k. The
/// differences are exact and terms never grow, so the error does not grow with K.
void compute_row(const ExtendedRows& rows, int radius, std::span<const double> orders,
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
    texture[x] *= orders[x] / 8;  // a ring has eight samples
  }
}
void compute_row(const ExtendedRows& rows, int radius, std::span<const float> orders,
                 std::span<float> texture) {
  gl_row(rows, radius, orders.data(), texture.data());
}

/// \param orders_of_row  takes y and a buffer for one row; returns the row's orders, with one
///   vector of slack in float
template <typename Real, typename OrdersOfRow>
Plane<Real> compute_texture(const GreyImage& image, int radius, OrdersOfRow orders_of_row) {
  Plane<Real> texture(image.height(), image.width());
  for_each_strip(image.height(), image.width(), [&](Rows strip) {
    AlignedRows<Real> orders(1, static_cast<std::size_t>(image.width()), 0);
    ExtendedRows rows(image, radius, strip.first);
    for (int y = strip.first; y < strip.last; ++y) {
      rows.next_row();
      compute_row(rows, radius, orders_of_row(y, orders.row(0)), texture.row(y));
    }
  });
  return texture;
}

/// \param weight_sum  takes y and x; returns S_K of the pixel's order
template <typename WeightSum>
void apply(Norm norm, const GreyImage& image, Plane<double>& texture, WeightSum weight_sum) {
  if (norm == Norm::additive) return;
  const double mean = mean_of(image);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      double& sample = texture.at(y, x);
      if (norm == Norm::sum) sample /= weight_sum(y, x);
      if (norm == Norm::none) sample += weight_sum(y, x) * (image.at(y, x) - mean);
    }
  }
}

}  // namespace

template <>
Plane<double> gl_texture<double>(const GreyImage& image, int radius, double order) {
  const std::vector<double> row(static_cast<std::size_t>(image.width()), order);
  return compute_texture<double>(image, radius,
                                 [&](int, double*) { return std::span<const double>(row); });
}

template <typename Real>
Plane<Real> gl_texture(const GreyImage& image, int radius, const Plane<double>& orders) {
  const auto width = static_cast<std::size_t>(image.width());
  return compute_texture<Real>(image, radius, [&](int y, Real* row_orders) {
    const auto half_orders = orders.row(y / 2);
    for (std::size_t x = 0; x < width; ++x) row_orders[x] = static_cast<Real>(half_orders[x / 2]);
    return std::span<const Real>(row_orders, width);
  });
}

template Plane<float> gl_texture<float>(const GreyImage&, int, const Plane<double>&);
template Plane<double> gl_texture<double>(const GreyImage&, int, const Plane<double>&);

double gl_weight_sum(double order, int radius) {
  if (!(order >= 0.0 && order < 1.0)) throw std::invalid_argument("order: must be in [0, 1)");
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
  for (double& sample : sums.samples()) sample = gl_weight_sum(sample, radius);
  apply(norm, image, texture, [&sums](int y, int x) { return sums.at(y / 2, x / 2); });
}

}  // namespace touchtrial::engine
