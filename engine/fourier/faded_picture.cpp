#include "engine/fourier/faded_picture.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace touchtrial::engine {
namespace {

std::vector<double> hann(int count) {
  std::vector<double> window(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (i + 0.5) / count);
  }
  return window;
}

}  // namespace

void load_windowed(const GreyImage& picture, RealFft<double>& fft) {
  const double mean = mean_of(picture);
  const std::vector<double> window_y = hann(picture.height());
  const std::vector<double> window_x = hann(picture.width());
  double* sample = fft.plane().data();
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      *sample++ = (picture.at(y, x) - mean) * window_y[y] * window_x[x];
    }
  }
}

}  // namespace touchtrial::engine
