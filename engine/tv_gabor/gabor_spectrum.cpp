#include "engine/tv_gabor/gabor_spectrum.hpp"

#include "engine/fourier/real_fft.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace touchtrial::engine {
namespace {

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

/// The patch lies in the torus' corner: a shift does not change |g^|.
void place_in_corner(const Patch& patch, std::span<double> plane, int width) {
  std::fill(plane.begin(), plane.end(), 0.0);
  for (int y = 0; y < kPatchSide; ++y) {
    const auto row = plane.subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(width));
    std::copy_n(patch.begin() + y * kPatchSide, kPatchSide, row.begin());
  }
}

}  // namespace

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
  spectrum.at(0, 0) = 0.0;  // of patches without mean; what stands there is rounding
  const double largest = *std::max_element(spectrum.samples().begin(), spectrum.samples().end());
  for (double& power : spectrum.samples()) power /= largest;
  return spectrum;
}

}  // namespace touchtrial::engine
