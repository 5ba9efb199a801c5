#include "engine/metrics/picture_statistics.hpp"

#include "engine/fourier/faded_picture.hpp"
#include "engine/fourier/real_fft.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial::engine {
namespace {

constexpr double kMinCycles = 4.0;     // per shorter side
constexpr double kMaxFrequency = 0.4;  // cycles per pixel
constexpr double kRingsPerOctave = 4.0;
/// A ring with a smaller share of the strongest ring's power contains only rounding errors.
constexpr double kMinPowerShare = 1e-20;

/// Sums over the coefficients in one range of radial frequencies.
struct Ring {
  double log_frequency = 0.0;  ///< sum over the coefficients
  double power = 0.0;          ///< sum over the coefficients
  int coefficients = 0;
};

std::vector<Ring> rings_of(const GreyImage& image) {
  const int height = image.height();
  const int width = image.width();
  RealFft<double> fft(height, width);
  load_windowed(image, fft);
  fft.forward();
  const double min_frequency = kMinCycles / std::min(height, width);
  std::vector<Ring> rings(
      static_cast<std::size_t>(kRingsPerOctave * std::log2(kMaxFrequency / min_frequency)) + 1);
  const int columns = width / 2 + 1;
  for (int row = 0; row < height; ++row) {
    const double fy = static_cast<double>(std::min(row, height - row)) / height;
    for (int column = 0; column < columns; ++column) {
      const double frequency = std::hypot(fy, static_cast<double>(column) / width);
      if (frequency < min_frequency || frequency > kMaxFrequency) continue;
      Ring& ring =
          rings[static_cast<std::size_t>(kRingsPerOctave * std::log2(frequency / min_frequency))];
      ring.log_frequency += std::log(frequency);
      ring.power += std::norm(fft.spectrum()[static_cast<std::size_t>(row) * columns + column]);
      ++ring.coefficients;
    }
  }
  return rings;
}

}  // namespace

double entropy(const GreyImage& image) {
  if (image.empty()) throw std::invalid_argument("entropy: the image is empty");
  std::array<std::int64_t, 256> histogram{};
  for (const std::uint8_t sample : image.samples()) ++histogram[sample];
  const auto total = static_cast<double>(image.size());
  double sum = 0.0;
  for (const std::int64_t count : histogram) {
    if (count == 0) continue;
    const auto occurrences = static_cast<double>(count);
    sum += occurrences / total * std::log(total / occurrences);
  }
  return sum;
}

double spectrum_slope(const GreyImage& image) {
  if (std::min(image.height(), image.width()) < kSlopeSmallestSide) {
    throw std::invalid_argument("has " + std::to_string(image.width()) + " x " +
                                std::to_string(image.height()) +
                                " px; the spectrum needs at least " +
                                std::to_string(kSlopeSmallestSide) + " px on each side");
  }
  if (is_flat(image)) return 0.0;
  const std::vector<Ring> rings = rings_of(image);
  double max_power = 0.0;
  for (const Ring& ring : rings) max_power = std::max(max_power, ring.power);
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Ring& ring : rings) {
    if (ring.coefficients == 0 || ring.power <= kMinPowerShare * max_power) continue;
    const double frequency = ring.log_frequency / ring.coefficients;
    const double power = std::log(ring.power / ring.coefficients);
    n += 1.0;
    x += frequency;
    y += power;
    xx += frequency * frequency;
    xy += frequency * power;
  }
  const double spread = xx - x * x / std::max(n, 1.0);
  return n < 2.0 || spread <= 0.0 ? 0.0 : (xy - x * y / n) / spread;
}

}  // namespace touchtrial::engine
