#include "engine/perception/picture_features.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <stdexcept>

namespace touchtrial {
namespace {

constexpr double kPitchMm = 0.2;
constexpr int kSidePx = 240;

GreyImage drawn(const std::function<double(double, double)>& grey, int height = kSidePx,
                int width = kSidePx) {
  GreyImage picture(height, width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      picture.at(y, x) = static_cast<std::uint8_t>(std::lround(128.0 + grey(x, y)));
    }
  }
  return picture;
}

/// \param toward_deg  direction of the wave, from x towards y
GreyImage grating(double wavelength_mm, double toward_deg, double amplitude = 40.0) {
  const double angle = toward_deg * std::numbers::pi / 180.0;
  const double per_px = 2.0 * std::numbers::pi * kPitchMm / wavelength_mm;
  return drawn([=](double x, double y) {
    return amplitude * std::sin(per_px * (x * std::cos(angle) + y * std::sin(angle)));
  });
}

int strongest(const engine::FeltFeatures& features, int first, int count) {
  int found = 0;
  for (int i = 1; i < count; ++i) {
    if (features[static_cast<std::size_t>(first + i)] >
        features[static_cast<std::size_t>(first + found)]) {
      found = i;
    }
  }
  return found;
}

TEST_CASE("a grating shows in the band of its wavelength, in gradient and grey level") {
  // Bands: 16 to 8 mm, 8 to 4, 4 to 2, 2 to 1, 1 to 0.5.
  const double middles_mm[] = {11.0, 5.7, 2.8, 1.4, 0.7};
  for (int band = 0; band < engine::kFeltBands; ++band) {
    const auto features = engine::features_of_picture(grating(middles_mm[band], 30.0), kPitchMm);
    CHECK(strongest(features, engine::kLateralBandsAt, engine::kFeltBands) == band);
    CHECK(strongest(features, engine::kNormalBandsAt, engine::kFeltBands) == band);
  }
}

TEST_CASE("a grating's gradient is its grey level times the wave number") {
  const auto features = engine::features_of_picture(grating(2.8, 0.0), kPitchMm);
  CHECK(features[engine::kLateralBandsAt + 2] - features[engine::kNormalBandsAt + 2] ==
        Approx(std::log(2.0 * std::numbers::pi / 2.8)).margin(0.01));
  // Under Hann windows in both directions a sine's mean square is that of the sine times (3/8)^2.
  CHECK(features[engine::kNormalBandsAt + 2] ==
        Approx(std::log(40.0 / std::sqrt(2.0) * 0.375)).margin(0.01));
}

TEST_CASE("a grating shows along its own direction and least across it") {
  for (int i = 0; i < engine::kFeltDirections; ++i) {
    const auto features = engine::features_of_picture(grating(3.0, 45.0 * i), kPitchMm);
    CHECK(strongest(features, engine::kDirectionsAt, engine::kFeltDirections) == i);
    const int across = (i + 2) % engine::kFeltDirections;
    CHECK(features[static_cast<std::size_t>(engine::kDirectionsAt + i)] >
          features[static_cast<std::size_t>(engine::kDirectionsAt + across)] + 1.5);
  }
}

TEST_CASE("twice the contrast adds ln 2 to every feature") {
  const auto mixed = [](double amplitude) {
    return drawn([=](double x, double y) {
      return amplitude * (std::sin(0.2 * x + 0.1 * y) + std::sin(0.9 * y) + std::sin(1.8 * x) +
                          std::sin(0.06 * (x + y)) + std::sin(0.45 * x));
    });
  };
  const auto weak = engine::features_of_picture(mixed(12.0), kPitchMm);
  const auto strong = engine::features_of_picture(mixed(24.0), kPitchMm);
  for (std::size_t f = 0; f < weak.size(); ++f) {
    CHECK(strong[f] - weak[f] == Approx(std::log(2.0)).margin(0.02));
  }
}

TEST_CASE("texture in one part of a picture shows in that part") {
  for (int part = 0; part < engine::kFeltParts; ++part) {
    const double x0 = 80.0 * (part % 3);
    const double y0 = 80.0 * (part / 3);
    const auto features = engine::features_of_picture(
        drawn([=](double x, double y) {
          const bool is_in = x >= x0 && x < x0 + 80 && y >= y0 && y < y0 + 80;
          return is_in ? 40.0 * std::sin(0.5 * x) : 0.0;
        }),
        kPitchMm);
    CHECK(strongest(features, engine::kPartsAt, engine::kFeltParts) == part);
  }
}

TEST_CASE("the squares of the parts are those of the bands") {
  // Parseval: the mean over nine equal parts is the sum over the bands.
  const auto features = engine::features_of_picture(grating(2.8, 20.0), kPitchMm);
  double bands = 0.0;
  for (int i = 0; i < engine::kFeltBands; ++i) {
    bands += std::exp(2.0 * features[static_cast<std::size_t>(engine::kLateralBandsAt + i)]);
  }
  double parts = 0.0;
  for (int i = 0; i < engine::kFeltParts; ++i) {
    parts += std::exp(2.0 * features[static_cast<std::size_t>(engine::kPartsAt + i)]) / 9.0;
  }
  CHECK(parts == Approx(bands));
}

TEST_CASE("a flat picture, a thin one and one too small for any felt wave have finite features") {
  const auto flat = drawn([](double, double) { return 0.0; });
  for (const double feature : engine::features_of_picture(flat, kPitchMm)) {
    CHECK(feature == Approx(std::log(1e-3)));
  }
  for (const auto& [height, width] : {std::pair(1, 1), {1, 300}, {301, 2}, {17, 31}}) {
    const auto odd =
        drawn([](double x, double y) { return 20.0 * std::sin(0.7 * x + y); }, height, width);
    for (const double feature : engine::features_of_picture(odd, kPitchMm)) {
      CHECK(std::isfinite(feature));
    }
  }
}

TEST_CASE("an empty picture and an impossible pitch are refused") {
  CHECK_THROWS_AS(engine::features_of_picture(GreyImage(), kPitchMm), std::invalid_argument);
  CHECK_THROWS_AS(engine::features_of_picture(GreyImage(4, 4), 0.0), std::invalid_argument);
  CHECK_THROWS_AS(engine::features_of_picture(GreyImage(4, 4), std::nan("")),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
