#include "engine/metrics/picture_statistics.hpp"

#include "core/random.hpp"
#include "engine/example_images.hpp"
#include "engine/fourier/real_fft.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <stdexcept>

using namespace touchtrial;
using namespace touchtrial::engine;

namespace {

/// Noise whose power falls with the frequency to the power `slope`.
GreyImage noise_of_slope(double slope, int side) {
  RandomStream random(11, "slope test");
  RealFft<double> fft(side, side);
  const int columns = side / 2 + 1;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double frequency = std::hypot(std::min(row, side - row), column);
      const double amplitude = frequency > 0.0 ? std::pow(frequency, slope / 2.0) : 0.0;
      fft.spectrum()[static_cast<std::size_t>(row * columns + column)] =
          std::polar(amplitude, random.uniform(0.0, 2.0 * std::numbers::pi));
    }
  }
  fft.inverse();
  const auto samples = fft.plane();
  double squares = 0.0;
  for (const double sample : samples) squares += sample * sample;
  const double scale = 40.0 / std::sqrt(squares / static_cast<double>(samples.size()));
  GreyImage image(side, side);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double grey = std::clamp(128.0 + scale * samples[i], 0.0, 255.0);
    image.samples()[i] = static_cast<std::uint8_t>(std::lround(grey));
  }
  return image;
}

}  // namespace

TEST_CASE("entropy of a constant image is exactly zero") {
  for (const int level : {0, 128, 255}) {
    const double value = entropy(flat_image({7, 5}, level));
    CHECK(value == 0.0);
    CHECK_FALSE(std::signbit(value));
  }
}

TEST_CASE("entropy of all levels in equal shares is ln 256") {
  GreyImage image(16, 16);
  std::iota(image.samples().begin(), image.samples().end(), std::uint8_t{0});
  CHECK(entropy(image) == Approx(std::log(256.0)).epsilon(1e-14));
}

TEST_CASE("entropy of two levels follows from their shares") {
  GreyImage image(1, 4);
  image.at(0, 3) = 200;
  CHECK(entropy(image) == Approx(-0.75 * std::log(0.75) - 0.25 * std::log(0.25)).epsilon(1e-14));
}

TEST_CASE("entropy does not depend on where the samples lie") {
  const GreyImage tall = ramp_image({1, 60}, 5);
  GreyImage wide(60, 1);
  for (int i = 0; i < 60; ++i) wide.at(59 - i, 0) = tall.at(0, i);
  CHECK(entropy(wide) == Approx(entropy(tall)).epsilon(1e-14));
}

TEST_CASE("entropy refuses an empty image") {
  CHECK_THROWS_AS(entropy(GreyImage()), std::invalid_argument);
}

TEST_CASE("the slope of noise made with a slope is that slope") {
  CHECK(spectrum_slope(noise_of_slope(0.0, 160)) == Approx(0.0).margin(0.12));
  CHECK(spectrum_slope(noise_of_slope(-1.0, 160)) == Approx(-1.0).margin(0.15));
  CHECK(spectrum_slope(noise_of_slope(-2.0, 160)) == Approx(-2.0).margin(0.15));
}

TEST_CASE("contrast and brightness do not change the slope") {
  const GreyImage image = noise_of_slope(-1.5, 96);
  GreyImage dim = image;
  for (std::uint8_t& grey : dim.samples()) grey = static_cast<std::uint8_t>(20 + grey / 2);
  CHECK(spectrum_slope(dim) == Approx(spectrum_slope(image)).margin(0.03));
}

TEST_CASE("a flat picture has slope 0, and one that is too small is refused") {
  CHECK(spectrum_slope(GreyImage(64, 40, 200)) == 0.0);
  CHECK(std::isfinite(spectrum_slope(noise_of_slope(-1.0, kSlopeSmallestSide))));
  CHECK_THROWS_AS(spectrum_slope(GreyImage(kSlopeSmallestSide - 1, 200, 3)), std::invalid_argument);
}
