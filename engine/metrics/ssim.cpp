#include "engine/metrics/ssim.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial::engine {
namespace {

constexpr std::array<double, 5> kWangWeights = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
constexpr std::size_t kTaps = 11;
constexpr double kC1 = 0.01 * 255 * 0.01 * 255;
constexpr double kC2 = 0.03 * 255 * 0.03 * 255;

std::string size_of(const GreyImage& image) {
  return std::to_string(image.height()) + " x " + std::to_string(image.width());
}

void check_sizes(const GreyImage& a, const GreyImage& b) {
  if (a.height() != b.height() || a.width() != b.width()) {
    throw std::invalid_argument("ms_ssim: the images differ in size, " + size_of(a) + " and " +
                                size_of(b) + " pixels");
  }
  if (std::min(a.height(), a.width()) < kMsSsimSmallestSide) {
    throw std::invalid_argument("ms_ssim: the images are " + size_of(a) +
                                " pixels, and both sides must be at least " +
                                std::to_string(kMsSsimSmallestSide));
  }
}

/// One side of the Gaussian window, of sum 1.
std::array<double, kTaps> window_weights() {
  std::array<double, kTaps> weights{};
  double sum = 0.0;
  for (std::size_t i = 0; i < kTaps; ++i) {
    const double distance = static_cast<double>(i) - 5.0;
    weights[i] = std::exp(-distance * distance / (2 * 1.5 * 1.5));
    sum += weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// x, y, x^2, y^2 and x y of one row.
using Moments = std::array<std::vector<double>, 5>;

template <typename Sample>
Moments moments_of_row(const Plane<Sample>& x, const Plane<Sample>& y, int row) {
  Moments moments;
  for (std::vector<double>& moment : moments) moment.resize(static_cast<std::size_t>(x.width()));
  const auto row_x = x.row(row), row_y = y.row(row);
  for (std::size_t i = 0; i < row_x.size(); ++i) {
    const double a = row_x[i], b = row_y[i];
    moments[0][i] = a;
    moments[1][i] = b;
    moments[2][i] = a * a;
    moments[3][i] = b * b;
    moments[4][i] = a * b;
  }
  return moments;
}

/// Means over all windows.
struct Means {
  double structure = 0.0;  ///< of c s
  double luminance = 0.0;  ///< of l
};

/// Adds one row of windows from the moments' weighted means.
void add_windows(const Moments& means, Means& sum) {
  for (std::size_t i = 0; i < means[0].size(); ++i) {
    const double a = means[0][i], b = means[1][i];
    const double variances = (means[2][i] - a * a) + (means[3][i] - b * b);
    const double covariance = means[4][i] - a * b;
    sum.structure += (2 * covariance + kC2) / (variances + kC2);
    sum.luminance += (2 * (a * b) + kC1) / ((a * a + b * b) + kC1);
  }
}

/// Filters along x and then, over the last rows, along y, so that memory is that of eleven rows.
template <typename Sample>
Means means_of(const Plane<Sample>& x, const Plane<Sample>& y) {
  const std::array<double, kTaps> weights = window_weights();
  const auto windows = static_cast<std::size_t>(x.width()) - (kTaps - 1);
  std::array<Moments, kTaps> filtered;  // row y is in slot y mod kTaps
  Means sum;
  for (int row = 0; row < x.height(); ++row) {
    const Moments moments = moments_of_row(x, y, row);
    Moments& slot = filtered[static_cast<std::size_t>(row) % kTaps];
    for (std::size_t m = 0; m < moments.size(); ++m) {
      slot[m].assign(windows, 0.0);
      for (std::size_t tap = 0; tap < kTaps; ++tap) {
        for (std::size_t i = 0; i < windows; ++i) slot[m][i] += weights[tap] * moments[m][i + tap];
      }
    }
    if (row + 1 < static_cast<int>(kTaps)) continue;
    Moments means;
    for (std::size_t m = 0; m < means.size(); ++m) {
      means[m].assign(windows, 0.0);
      for (std::size_t tap = 0; tap < kTaps; ++tap) {
        const auto& from = filtered[(static_cast<std::size_t>(row) + 1 + tap) % kTaps][m];
        for (std::size_t i = 0; i < windows; ++i) means[m][i] += weights[tap] * from[i];
      }
    }
    add_windows(means, sum);
  }
  const double count = static_cast<double>(windows) * (x.height() - static_cast<int>(kTaps) + 1);
  return {sum.structure / count, sum.luminance / count};
}

/// The means of blocks of 2 x 2 samples; an odd last row or column is repeated.
template <typename Sample>
Plane<double> halved(const Plane<Sample>& plane) {
  Plane<double> half((plane.height() + 1) / 2, (plane.width() + 1) / 2);
  for (int y = 0; y < half.height(); ++y) {
    const auto upper = plane.row(2 * y);
    const auto lower = plane.row(std::min(2 * y + 1, plane.height() - 1));
    for (int x = 0; x < half.width(); ++x) {
      const auto left = static_cast<std::size_t>(2 * x);
      const auto right = static_cast<std::size_t>(std::min(2 * x + 1, plane.width() - 1));
      const auto of = [&](const auto& row) {
        return static_cast<double>(row[left]) + static_cast<double>(row[right]);
      };
      half.at(y, x) = 0.25 * (of(upper) + of(lower));
    }
  }
  return half;
}

/// Multiplies the product by the mean of one scale.
void include_scale(MsSsim& product, std::size_t scale, double mean) {
  product.unit *= mean;
  product.wang *= std::pow(std::max(mean, 0.0), kWangWeights[scale]);
}

}  // namespace

MsSsim ms_ssim(const GreyImage& a, const GreyImage& b) {
  check_sizes(a, b);
  MsSsim product{1.0, 1.0};
  include_scale(product, 0, means_of(a, b).structure);
  Plane<double> x = halved(a), y = halved(b);
  constexpr std::size_t kLast = kWangWeights.size() - 1;
  for (std::size_t scale = 1; scale < kLast; ++scale) {
    include_scale(product, scale, means_of(x, y).structure);
    x = halved(x);
    y = halved(y);
  }
  const Means last = means_of(x, y);
  include_scale(product, kLast, last.structure);
  include_scale(product, kLast, last.luminance);
  return product;
}

}  // namespace touchtrial::engine
