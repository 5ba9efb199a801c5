#include "engine/tv_gabor/problem.hpp"

#include "engine/fourier/plane_filter.hpp"
#include "engine/symmetric_extension.hpp"
#include "engine/tv_gabor/row_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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
      const double distance = x * std::cos(direction) + y * std::sin(direction);
      patch[i] = std::exp(-(x * x + y * y) / (2.0 * kSigma_px * kSigma_px)) *
                 std::cos(radians_per_px * distance);
    }
  }
  const double mean = std::accumulate(patch.begin(), patch.end(), 0.0) / patch.size();
  for (double& sample : patch) sample -= mean;
  return patch;
}

/// cos and sin of 2 pi offset i / length for each i < count.
struct Wave {
  Wave(int offset, int count, int length)
      : cosine(static_cast<std::size_t>(count)), sine(cosine.size()) {
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * (offset * i % length) / length;
      cosine[static_cast<std::size_t>(i)] = std::cos(angle);
      sine[static_cast<std::size_t>(i)] = std::sin(angle);
    }
  }

  std::vector<double> cosine, sine;
};

/// Waves for all offsets from a patch's centre to its edge.
std::vector<Wave> make_waves(int count, int length) {
  std::vector<Wave> result;
  for (int offset = 0; offset <= kPatchRadius; ++offset) result.emplace_back(offset, count, length);
  return result;
}

/// target += factor * source
void add(double factor, const std::vector<double>& source, std::vector<double>& target) {
  for (std::size_t i = 0; i < target.size(); ++i) target[i] += factor * source[i];
}

/// Adds |g^|^2 by its definition. A patch is point-symmetric, so its transform is real, and rows
/// above the centre contribute as much as the rows below it.
void add_power(const Patch& patch, const std::vector<Wave>& along_x,
               const std::vector<Wave>& along_y, Plane<double>& spectrum) {
  const std::vector<double> zeros(static_cast<std::size_t>(spectrum.width()));
  std::array<std::vector<double>, kPatchRadius + 1> real, imaginary;  // rows' transforms
  for (std::size_t y = 0; y <= kPatchRadius; ++y) {
    real[y] = imaginary[y] = zeros;
    const double* const centre = patch.data() + (y + kPatchRadius) * kPatchSide + kPatchRadius;
    add(centre[0], along_x[0].cosine, real[y]);
    for (std::size_t x = 1; x <= kPatchRadius; ++x) {
      const double right = centre[x], left = *(centre - x);
      add(right + left, along_x[x].cosine, real[y]);
      add(right - left, along_x[x].sine, imaginary[y]);
    }
  }
  std::array<const double*, kPatchRadius + 1> re{}, im{};
  for (std::size_t y = 0; y <= kPatchRadius; ++y) {
    re[y] = real[y].data();
    im[y] = imaginary[y].data();
  }
  for (int i = 0; i < spectrum.height(); ++i) {
    std::array<double, kPatchRadius + 1> cosine{}, sine{};
    for (std::size_t y = 1; y <= kPatchRadius; ++y) {
      cosine[y] = 2.0 * along_y[y].cosine[static_cast<std::size_t>(i)];
      sine[y] = 2.0 * along_y[y].sine[static_cast<std::size_t>(i)];
    }
    const auto row = spectrum.row(i);
    for (std::size_t x = 0; x < row.size(); ++x) {
      double transform = re[0][x];
      for (std::size_t y = 1; y <= kPatchRadius; ++y) {
        transform += cosine[y] * re[y][x] - sine[y] * im[y][x];
      }
      row[x] += transform * transform;
    }
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
    const auto source = image.row(symmetric_index(y - kTorusMargin, image.height()));
    const auto target = torus.row(y);
    for (int x = 0; x < torus.width(); ++x) {
      target[x] = static_cast<Real>(source[symmetric_index(x - kTorusMargin, image.width())]);
    }
  }
  return torus;
}

Plane<double> gabor_spectrum(std::span<const GaborComponent> components, int height, int width) {
  Plane<double> spectrum(height, width / 2 + 1);
  const std::vector<Wave> along_x = make_waves(spectrum.width(), width);
  const std::vector<Wave> along_y = make_waves(height, height);
  for (const GaborComponent& component : components) {
    add_power(zero_mean_gabor_patch(component), along_x, along_y, spectrum);
  }
  spectrum.at(0, 0) = 0.0;  // removes rounding: the patches have no mean
  const double max_power = *std::max_element(spectrum.samples().begin(), spectrum.samples().end());
  for (double& power : spectrum.samples()) power /= max_power;
  return spectrum;
}

template <typename Real>
TvGaborProblem<Real> tv_gabor_problem(const GreyImage& image, const TvGaborOptions& options) {
  const int height = torus_length(image.height());
  const int width = torus_length(image.width());
  return {extended_to_torus<Real>(image),
          arranged_factors<Real>(gabor_spectrum(options.components, height, width), width),
          options.lambda};
}

template <typename Real>
double mean_gradient(const Plane<Real>& torus) {
  const auto width = static_cast<std::size_t>(torus.width());
  const std::vector<Real> zeros(width);  // texture and dual point
  double sum = 0.0;
  for (int y = 0; y < torus.height(); ++y) {
    const int y_below = y + 1 == torus.height() ? 0 : y + 1;
    const GapRow<Real> row{.image = torus.row(y).data(),
                           .image_below = torus.row(y_below).data(),
                           .texture = zeros.data(),
                           .texture_below = zeros.data(),
                           .q_x = zeros.data(),
                           .q_y = zeros.data()};
    sum += row_kernels<Real>().gap(row, width).primal;
  }
  return sum / static_cast<double>(torus.size());
}

template Plane<float> extended_to_torus<float>(const GreyImage&);
template Plane<double> extended_to_torus<double>(const GreyImage&);

template TvGaborProblem<float> tv_gabor_problem<float>(const GreyImage&, const TvGaborOptions&);
template TvGaborProblem<double> tv_gabor_problem<double>(const GreyImage&, const TvGaborOptions&);
template double mean_gradient(const Plane<float>&);
template double mean_gradient(const Plane<double>&);

}  // namespace touchtrial::engine
