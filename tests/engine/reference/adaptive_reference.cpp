#include "engine/reference/adaptive_reference.hpp"

#include "engine/reference/mirror.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace touchtrial::reference {
namespace {

std::array<double, 4> taps(Tap tap) {
  const double s = std::sqrt(3.0);
  const double norm = 4.0 * std::sqrt(2.0);
  const std::array<double, 4> h = {(1 + s) / norm, (3 + s) / norm, (3 - s) / norm, (1 - s) / norm};
  if (tap == Tap::low) return h;
  return {h[3], -h[2], h[1], -h[0]};
}

double sobel_norm(const Plane<double>& band, int y, int x) {
  static constexpr int kSmooth[3] = {1, 2, 1};
  static constexpr int kSlope[3] = {-1, 0, 1};
  double gx = 0.0;
  double gy = 0.0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const double sample = mirrored_sample(band, y + j - 1, x + i - 1);
      gx += kSmooth[j] * kSlope[i] * sample;
      gy += kSlope[j] * kSmooth[i] * sample;
    }
  }
  return std::sqrt(gx * gx + gy * gy);
}

/// Sum over the rays and the distances of |c_k| (centre - sample) / 8.
double difference_at(const GreyImage& image, int y, int x, double order, int radius) {
  static constexpr int kDirections[8][2] = {{0, 1}, {0, -1}, {1, 0},  {-1, 0},
                                            {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  double sum = 0.0;
  double c = 1.0;
  for (int k = 1; k <= radius; ++k) {
    c *= (k - 1 - order) / k;
    for (const auto& direction : kDirections) {
      const double sample = mirrored_sample(image, y + k * direction[0], x + k * direction[1]);
      sum += std::abs(c) * (image.at(y, x) - sample) / 8.0;
    }
  }
  return sum;
}

}  // namespace

template <typename Sample>
Plane<double> sub_band(const Plane<Sample>& plane, Tap along_x, Tap along_y) {
  const auto filter_x = taps(along_x);
  const auto filter_y = taps(along_y);
  Plane<double> band((plane.height() + 1) / 2, (plane.width() + 1) / 2);
  for (int y = 0; y < band.height(); ++y) {
    for (int x = 0; x < band.width(); ++x) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          band.at(y, x) += filter_y[static_cast<std::size_t>(j)] *
                           filter_x[static_cast<std::size_t>(i)] *
                           mirrored_sample(plane, 2 * y + j, 2 * x + i);
        }
      }
    }
  }
  return band;
}

template Plane<double> sub_band<std::uint8_t>(const GreyImage&, Tap, Tap);
template Plane<double> sub_band<double>(const Plane<double>&, Tap, Tap);

Plane<double> csgv(const GreyImage& image) {
  const std::vector<Plane<double>> bands = {
      sub_band(image, Tap::low, Tap::low), sub_band(image, Tap::low, Tap::high),
      sub_band(image, Tap::high, Tap::low), sub_band(image, Tap::high, Tap::high)};
  Plane<double> sum(image.height(), image.width());
  for (int y = 0; y < sum.height(); ++y) {
    for (int x = 0; x < sum.width(); ++x) {
      for (const Plane<double>& band : bands) sum.at(y, x) += sobel_norm(band, y / 2, x / 2);
    }
  }
  return sum;
}

Plane<double> order_map(const Plane<double>& csgv) {
  double largest = 0.0;
  for (const double value : csgv.samples()) largest = value > largest ? value : largest;
  Plane<double> orders(csgv.height(), csgv.width());
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const double value = csgv.samples()[i];
    if (value >= 2.0 && value <= 128.0) orders.samples()[i] = value / (3.0 * largest) + 0.666;
    if (value > 128.0) orders.samples()[i] = value / (2.0 * largest) + 0.499;
  }
  return orders;
}

Plane<double> texture(const GreyImage& image, const Plane<double>& orders, int radius) {
  Plane<double> result(image.height(), image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      result.at(y, x) = difference_at(image, y, x, orders.at(y, x), radius);
    }
  }
  return result;
}

}  // namespace touchtrial::reference
