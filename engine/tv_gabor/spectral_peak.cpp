#include "engine/tv_gabor/spectral_peak.hpp"

#include "engine/fourier/real_fft.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial::engine {
namespace {

/// sin^2(pi (n + 0.5) / N)
std::vector<double> hann_window(int length) {
  std::vector<double> window(static_cast<std::size_t>(length));
  for (int n = 0; n < length; ++n) {
    const double s = std::sin(std::numbers::pi * (n + 0.5) / length);
    window[static_cast<std::size_t>(n)] = s * s;
  }
  return window;
}

void load_windowed(const GreyImage& image, std::span<double> plane) {
  const double mean = std::accumulate(image.samples().begin(), image.samples().end(), 0.0) /
                      static_cast<double>(image.size());
  const std::vector<double> along_y = hann_window(image.height());
  const std::vector<double> along_x = hann_window(image.width());
  std::size_t i = 0;
  for (const double weight_y : along_y) {
    for (const double weight_x : along_x) {
      plane[i] = weight_y * weight_x * (image.samples()[i] - mean);
      ++i;
    }
  }
}

GaborComponent component_at(double frequency_x, double frequency_y) {
  const double degrees = std::atan2(frequency_y, frequency_x) * 180.0 / std::numbers::pi;
  return {std::hypot(frequency_x, frequency_y), degrees < 0.0 ? degrees + 180.0 : degrees};
}

bool in_range(const GaborComponent& component) {
  return component.frequency_cycles_per_px >= kLowestPeakFrequency &&
         component.frequency_cycles_per_px <= kHighestPeakFrequency;
}

}  // namespace

GaborComponent strongest_component(const GreyImage& image) {
  if (image.empty()) throw std::invalid_argument("strongest_component: the image is empty");
  const int height = image.height();
  const int width = image.width();
  RealFft<double> fft(height, width);
  load_windowed(image, fft.plane());
  fft.forward();
  std::optional<GaborComponent> strongest;
  double most = -1.0;
  std::size_t i = 0;
  for (int y = 0; y < height; ++y) {
    const double frequency_y = static_cast<double>(2 * y <= height ? y : y - height) / height;
    for (int x = 0; x <= width / 2; ++x, ++i) {
      const GaborComponent component = component_at(static_cast<double>(x) / width, frequency_y);
      const double power = std::norm(fft.spectrum()[i]);
      if (!in_range(component) || power <= most) continue;
      most = power;
      strongest = component;
    }
  }
  if (!strongest) {
    throw std::invalid_argument("components: auto needs an image of 3 px or more, not " +
                                std::to_string(width) + " x " + std::to_string(height));
  }
  return *strongest;
}

}  // namespace touchtrial::engine
