#include "engine/tv_gabor/problem.hpp"

#include "engine/fourier/real_fft.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <vector>

namespace touchtrial::engine {
namespace {

bool has_no_prime_factor_above_7(int n) {
  for (const int prime : {2, 3, 5, 7}) {
    while (n % prime == 0) n /= prime;
  }
  return n == 1;
}

constexpr int kPatchRadius = 5;
constexpr int kPatchSide = 2 * kPatchRadius + 1;
constexpr double kSigma_px = 2.0;

using Patch = std::array<double, kPatchSide * kPatchSide>;

Patch zero_mean_gabor_patch(const GaborComponent& component) {
  const double direction = component.direction_deg * std::numbers::pi / 180.0;
  const double radians_per_px = 2.0 * std::numbers::pi * component.frequency_cycles_per_px;
  Patch patch{};
  std::size_t i = 0;
  for (int y = -kPatchRadius; y <= kPatchRadius; ++y) {
    for (int x = -kPatchRadius; x <= kPatchRadius; ++x, ++i) {
      const double along = x * std::cos(direction) + y * std::sin(direction);
      patch[i] = std::exp(-(x * x + y * y) / (2.0 * kSigma_px * kSigma_px)) *
                 std::cos(radians_per_px * along);
    }
  }
  const double mean = std::accumulate(patch.begin(), patch.end(), 0.0) / patch.size();
  for (double& sample : patch) sample -= mean;
  return patch;
}

/// Places the patch in the corner of the torus: a shift does not change |g^|.
void place_in_corner(const Patch& patch, std::span<double> plane, int width) {
  std::fill(plane.begin(), plane.end(), 0.0);
  for (int y = 0; y < kPatchSide; ++y) {
    const auto row = plane.subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(width));
    std::copy_n(patch.begin() + y * kPatchSide, kPatchSide, row.begin());
  }
}

}  // namespace

int torus_length(int n) {
  int length = n + 2 * kTorusMargin;
  length += length % 2;
  while (!has_no_prime_factor_above_7(length)) length += 2;
  return length;
}

template <typename Real>
Plane<Real> extended_to_torus(const GreyImage& image) {
  Plane<Real> torus(torus_length(image.height()), torus_length(image.width()));
  for (int y = 0; y < torus.height(); ++y) {
    const auto from = image.row(symmetric_index(y - kTorusMargin, image.height()));
    const auto to = torus.row(y);
    for (int x = 0; x < torus.width(); ++x) {
      to[x] = static_cast<Real>(from[symmetric_index(x - kTorusMargin, image.width())]);
    }
  }
  return torus;
}

template <typename Real>
Plane<Real> cropped_from_torus(const Plane<Real>& torus, int height, int width) {
  Plane<Real> image(height, width);
  for (int y = 0; y < height; ++y) {
    const auto from = torus.row(y + kTorusMargin).subspan(kTorusMargin, width);
    std::copy(from.begin(), from.end(), image.row(y).begin());
  }
  return image;
}

Plane<double> gabor_spectrum(std::span<const GaborComponent> components, int height, int width) {
  RealFft<double> fft(height, width);
  Plane<double> spectrum(height, width / 2 + 1);
  for (const GaborComponent& component : components) {
    place_in_corner(zero_mean_gabor_patch(component), fft.plane(), width);
    fft.forward();
    for (std::size_t i = 0; i < spectrum.size(); ++i) {
      spectrum.samples()[i] += std::norm(fft.spectrum()[i]);
    }
  }
  spectrum.at(0, 0) = 0.0;  // the patches have no mean; anything here is rounding
  const double largest = *std::max_element(spectrum.samples().begin(), spectrum.samples().end());
  for (double& power : spectrum.samples()) power /= largest;
  return spectrum;
}

template <typename Real>
TvGaborProblem<Real> tv_gabor_problem(const GreyImage& image, const TvGaborOptions& options) {
  const int height = torus_length(image.height());
  const int width = torus_length(image.width());
  return {extended_to_torus<Real>(image),
          converted<Real>(gabor_spectrum(options.components, height, width)), options.lambda};
}

template <typename Real>
double mean_gradient(const Plane<Real>& torus) {
  std::vector<Real> along_x(static_cast<std::size_t>(torus.width())), along_y(along_x.size());
  double sum = 0.0;
  for (int y = 0; y < torus.height(); ++y) {
    const int below = y + 1 == torus.height() ? 0 : y + 1;
    gradient_of_row<Real>(torus.row(y), torus.row(below), along_x, along_y);
    for (std::size_t x = 0; x < along_x.size(); ++x) sum += std::hypot(along_x[x], along_y[x]);
  }
  return sum / static_cast<double>(torus.size());
}

template Plane<float> extended_to_torus<float>(const GreyImage&);
template Plane<double> extended_to_torus<double>(const GreyImage&);
template Plane<float> cropped_from_torus<float>(const Plane<float>&, int, int);
template Plane<double> cropped_from_torus<double>(const Plane<double>&, int, int);

template TvGaborProblem<float> tv_gabor_problem<float>(const GreyImage&, const TvGaborOptions&);
template TvGaborProblem<double> tv_gabor_problem<double>(const GreyImage&, const TvGaborOptions&);
template double mean_gradient(const Plane<float>&);
template double mean_gradient(const Plane<double>&);

}  // namespace touchtrial::engine
