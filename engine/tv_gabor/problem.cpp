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
      const double along = x * std::cos(direction) + y * std::sin(direction);
      patch[i] = std::exp(-(x * x + y * y) / (2.0 * kSigma_px * kSigma_px)) *
                 std::cos(radians_per_px * along);
    }
  }
  const double mean = std::accumulate(patch.begin(), patch.end(), 0.0) / patch.size();
  for (double& sample : patch) sample -= mean;
  return patch;
}

/// cos or sin of 2 pi offset frequency / length, for all `frequencies`.
template <typename Function>
std::vector<double> wave(Function function, int offset, int frequencies, int length) {
  std::vector<double> samples(static_cast<std::size_t>(frequencies));
  for (int i = 0; i < frequencies; ++i) {
    samples[static_cast<std::size_t>(i)] =
        function(2.0 * std::numbers::pi * (offset * i % length) / length);
  }
  return samples;
}

double cosine(double angle) {
  return std::cos(angle);
}
double sine(double angle) {
  return std::sin(angle);
}

/// The transforms of a patch's rows at distance y from its centre, by their definition.
struct TransformedRow {
  std::vector<double> real, imaginary;
};

TransformedRow transformed_row(const Patch& patch, int y, int width) {
  const int count = width / 2 + 1;
  TransformedRow row{std::vector<double>(static_cast<std::size_t>(count)),
                     std::vector<double>(static_cast<std::size_t>(count))};
  for (int x = -kPatchRadius; x <= kPatchRadius; ++x) {
    const double sample =
        patch[static_cast<std::size_t>((y + kPatchRadius) * kPatchSide + x + kPatchRadius)];
    const std::vector<double> along = wave(cosine, x, count, width);
    const std::vector<double> across = wave(sine, x, count, width);
    for (std::size_t i = 0; i < along.size(); ++i) {
      row.real[i] += sample * along[i];
      row.imaginary[i] += sample * across[i];
    }
  }
  return row;
}

/// Adds |g^|^2. A patch is the same in opposite places, so its transform is real, and rows above
/// the centre add what those below it add.
void add_power(const Patch& patch, Plane<double>& spectrum, int width) {
  const int height = spectrum.height();
  std::array<TransformedRow, kPatchRadius + 1> rows;
  std::array<std::vector<double>, kPatchRadius + 1> cosines, sines;
  for (int y = 0; y <= kPatchRadius; ++y) {
    const auto at = static_cast<std::size_t>(y);
    rows[at] = transformed_row(patch, y, width);
    cosines[at] = wave(cosine, y, height, height);
    sines[at] = wave(sine, y, height, height);
  }
  std::vector<double> transform(static_cast<std::size_t>(spectrum.width()));
  for (int i = 0; i < height; ++i) {
    transform = rows[0].real;
    for (std::size_t y = 1; y < rows.size(); ++y) {
      const double cosine_of_row = 2.0 * cosines[y][static_cast<std::size_t>(i)];
      const double sine_of_row = 2.0 * sines[y][static_cast<std::size_t>(i)];
      const double* const real = rows[y].real.data();
      const double* const imaginary = rows[y].imaginary.data();
      for (std::size_t x = 0; x < transform.size(); ++x) {
        transform[x] += cosine_of_row * real[x] - sine_of_row * imaginary[x];
      }
    }
    const auto row = spectrum.row(i);
    for (std::size_t x = 0; x < transform.size(); ++x) row[x] += transform[x] * transform[x];
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
  Plane<double> spectrum(height, width / 2 + 1);
  for (const GaborComponent& component : components) {
    add_power(zero_mean_gabor_patch(component), spectrum, width);
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
          arranged_factors<Real>(gabor_spectrum(options.components, height, width), width),
          options.lambda};
}

template <typename Real>
double mean_gradient(const Plane<Real>& torus) {
  std::vector<Real> along_x(static_cast<std::size_t>(torus.width())), along_y(along_x.size());
  double sum = 0.0;
  for (int y = 0; y < torus.height(); ++y) {
    const int below = y + 1 == torus.height() ? 0 : y + 1;
    gradient_of_row<Real>(torus.row(y), torus.row(below), along_x, along_y);
    norm_row(along_x.data(), along_y.data(), along_x.size(), along_x.data());
    for (const Real norm : along_x) sum += norm;
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
