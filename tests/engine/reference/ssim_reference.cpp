#include "engine/reference/ssim_reference.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::reference {
namespace {

constexpr double kC1 = 0.01 * 255 * 0.01 * 255;
constexpr double kC2 = 0.03 * 255 * 0.03 * 255;
constexpr double kC3 = kC2 / 2;

using Window = std::array<std::array<double, 11>, 11>;

/// Calls visit(weight, a, b) for every sample of the window whose corner is at (y, x).
template <typename Visit>
void visit_window(const Window& window, const Plane<double>& a, const Plane<double>& b, int y,
                  int x, Visit&& visit) {
  for (int j = 0; j < 11; ++j) {
    for (int i = 0; i < 11; ++i) visit(window[j][i], a.at(y + j, x + i), b.at(y + j, x + i));
  }
}

Similarity similarity_at(const Window& window, const Plane<double>& a, const Plane<double>& b,
                         int y, int x) {
  double mean_a = 0.0;
  double mean_b = 0.0;
  visit_window(window, a, b, y, x, [&](double weight, double sample_a, double sample_b) {
    mean_a += weight * sample_a;
    mean_b += weight * sample_b;
  });
  double variance_a = 0.0;
  double variance_b = 0.0;
  double covariance = 0.0;
  visit_window(window, a, b, y, x, [&](double weight, double sample_a, double sample_b) {
    variance_a += weight * (sample_a - mean_a) * (sample_a - mean_a);
    variance_b += weight * (sample_b - mean_b) * (sample_b - mean_b);
    covariance += weight * (sample_a - mean_a) * (sample_b - mean_b);
  });
  const double sigma_a = std::sqrt(variance_a);
  const double sigma_b = std::sqrt(variance_b);
  const double l = (2 * mean_a * mean_b + kC1) / (mean_a * mean_a + mean_b * mean_b + kC1);
  const double c = (2 * sigma_a * sigma_b + kC2) / (variance_a + variance_b + kC2);
  const double s = (covariance + kC3) / (sigma_a * sigma_b + kC3);
  return {l, c * s, l * c * s};
}

Plane<double> halved(const Plane<double>& plane) {
  Plane<double> half((plane.height() + 1) / 2, (plane.width() + 1) / 2);
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) {
      double sum = 0.0;
      for (const int row : {2 * y, std::min(2 * y + 1, plane.height() - 1)}) {
        for (const int column : {2 * x, std::min(2 * x + 1, plane.width() - 1)}) {
          sum += plane.at(row, column);
        }
      }
      half.at(y, x) = sum / 4;
    }
  }
  return half;
}

}  // namespace

Window ssim_window() {
  Window window{};
  double sum = 0.0;
  for (int j = 0; j < 11; ++j) {
    for (int i = 0; i < 11; ++i) {
      window[j][i] = std::exp(-((j - 5) * (j - 5) + (i - 5) * (i - 5)) / (2 * 1.5 * 1.5));
      sum += window[j][i];
    }
  }
  for (auto& row : window) {
    for (double& weight : row) weight /= sum;
  }
  return window;
}

Similarity similarity(const Plane<double>& a, const Plane<double>& b) {
  const Window window = ssim_window();
  Similarity sum{0.0, 0.0, 0.0};
  for (int y = 0; y + 11 <= a.height(); ++y) {
    for (int x = 0; x + 11 <= a.width(); ++x) {
      const Similarity here = similarity_at(window, a, b, y, x);
      sum.l += here.l;
      sum.cs += here.cs;
      sum.lcs += here.lcs;
    }
  }
  const double windows = static_cast<double>(a.height() - 10) * (a.width() - 10);
  return {sum.l / windows, sum.cs / windows, sum.lcs / windows};
}

MsSsim ms_ssim(const GreyImage& a, const GreyImage& b) {
  constexpr std::array<double, 5> kWeights = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
  Plane<double> scaled_a = converted<double>(a);
  Plane<double> scaled_b = converted<double>(b);
  MsSsim product{1.0, 1.0};
  for (std::size_t scale = 0; scale < kWeights.size(); ++scale) {
    const Similarity mean = similarity(scaled_a, scaled_b);
    const double l = scale == 4 ? mean.l : 1.0;
    product.unit *= mean.cs * l;
    product.wang *= std::pow(std::max(0.0, mean.cs), kWeights[scale]);
    product.wang *= std::pow(std::max(0.0, l), kWeights[scale]);
    scaled_a = halved(scaled_a);
    scaled_b = halved(scaled_b);
  }
  return product;
}

}  // namespace touchtrial::reference
