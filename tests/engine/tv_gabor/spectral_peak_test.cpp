#include "engine/tv_gabor/spectral_peak.hpp"

#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/refusal.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace touchtrial {
namespace {

/// 128 + 60 cos, of a wave along `direction_deg`.
GreyImage wave(Size size, double frequency, double direction_deg) {
  const double direction = direction_deg * std::numbers::pi / 180.0;
  GreyImage image(size.height, size.width);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double along = x * std::cos(direction) + y * std::sin(direction);
      const double level = 128.0 + 60.0 * std::cos(2.0 * std::numbers::pi * frequency * along);
      image.at(y, x) = static_cast<std::uint8_t>(std::lround(level));
    }
  }
  return image;
}

/// The power of the windowed image at one frequency, by its definition.
double power_at(const GreyImage& image, double fx, double fy) {
  double mean = 0.0;
  for (const std::uint8_t sample : image.samples()) mean += sample;
  mean /= static_cast<double>(image.size());
  std::complex<double> sum = 0.0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double wy = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (y + 0.5) / image.height());
      const double wx = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (x + 0.5) / image.width());
      sum += wy * wx * (image.at(y, x) - mean) *
             std::polar(1.0, -2.0 * std::numbers::pi * (fx * x + fy * y));
    }
  }
  return std::norm(sum);
}

TEST_CASE("the strongest component of a wave is the wave") {
  for (const double direction : {0.0, 90.0}) {
    const engine::GaborComponent found =
        engine::strongest_component(wave({100, 100}, 0.2, direction));
    CHECK(found.frequency_cycles_per_px == Approx(0.2));
    CHECK(found.direction_deg == Approx(direction));
  }
  for (const double direction : {30.0, 45.0, 150.0}) {
    const engine::GaborComponent found =
        engine::strongest_component(wave({128, 160}, 0.3, direction));
    CHECK(found.frequency_cycles_per_px == Approx(0.3).margin(0.006));
    CHECK(found.direction_deg == Approx(direction).margin(1.5));
  }
}

TEST_CASE("shading below 0.04 cycles per pixel is not taken for texture") {
  GreyImage image = wave({200, 200}, 0.02, 0.0);
  const GreyImage ripple = wave({200, 200}, 0.25, 90.0);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.samples()[i] =
        static_cast<std::uint8_t>(image.samples()[i] / 2 + ripple.samples()[i] / 4);
  }
  const engine::GaborComponent found = engine::strongest_component(image);
  CHECK(found.frequency_cycles_per_px == Approx(0.25));
  CHECK(found.direction_deg == Approx(90.0));
}

TEST_CASE("no frequency of the grid within the range is stronger than the strongest") {
  for (const Size size : {Size{16, 21}, Size{15, 16}, Size{3, 3}, Size{1, 12}}) {
    const GreyImage image = cloth_image(size);
    const engine::GaborComponent found = engine::strongest_component(image);
    const double direction = found.direction_deg * std::numbers::pi / 180.0;
    const double most = power_at(image, found.frequency_cycles_per_px * std::cos(direction),
                                 found.frequency_cycles_per_px * std::sin(direction));
    for (int ky = -size.height / 2; ky <= size.height / 2; ++ky) {
      for (int kx = 0; kx <= size.width / 2; ++kx) {
        const double fy = static_cast<double>(ky) / size.height;
        const double fx = static_cast<double>(kx) / size.width;
        if (std::hypot(fx, fy) < 0.04 || std::hypot(fx, fy) > 0.45) continue;
        CHECK(power_at(image, fx, fy) <= most * (1.0 + 1e-9) + 1e-9);
      }
    }
  }
}

TEST_CASE("an image without any frequency in the range is refused") {
  for (const Size size : {Size{1, 1}, Size{2, 2}, Size{1, 2}}) {
    CHECK(refusal_of([&] {
            (void)engine::strongest_component(noise_image(size));
          }).starts_with("components: auto needs an image of 3 px or more, not "));
  }
  CHECK_FALSE(refusal_of([] { (void)engine::strongest_component(GreyImage()); }).empty());
}

TEST_CASE("automatic tv-gabor is tv-gabor with the strongest component, and says which") {
  const GreyImage image = wave({48, 40}, 0.2, 0.0);
  engine::ExtractionOptions automatic;
  automatic.method = engine::Method::tv_gabor;
  automatic.tv_gabor.automatic = true;
  automatic.tv_gabor.components.clear();
  engine::ExtractionOptions listed = automatic;
  listed.tv_gabor.automatic = false;
  listed.tv_gabor.components = {engine::strongest_component(image)};
  const auto result = engine::extract_texture<double>(image, automatic);
  CHECK(result.components == listed.tv_gabor.components);
  CHECK(result.texture == engine::extract_texture<double>(image, listed).texture);
  const auto flat = engine::extract_texture<double>(flat_image({2, 2}, 9), automatic);
  CHECK(largest_magnitude(flat.texture) == 0.0);
  CHECK(flat.components.empty());
}

}  // namespace
}  // namespace touchtrial
