#include "stimuli/import/picture_levels.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace touchtrial;
using namespace touchtrial::stimuli;

namespace {

/// A wave across the columns: a whole number of periods.
GreyImage wave(int side_px, double wavelength_px, double mean, double amplitude) {
  GreyImage image(side_px, side_px);
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      image.at(y, x) = static_cast<std::uint8_t>(
          std::lround(mean + amplitude * std::sin(2 * std::numbers::pi * x / wavelength_px)));
    }
  }
  return image;
}

}  // namespace

TEST_CASE("levels of a wave are its mean, its rms and its wavelength") {
  const PictureLevels levels = levels_of(wave(200, 20.0, 120.0, 60.0));
  CHECK(levels.mean_grey == Approx(120.0).margin(0.2));
  CHECK(levels.rms_grey == Approx(60.0 / std::sqrt(2.0)).epsilon(0.01));
  CHECK(levels.feature_px == Approx(20.0).epsilon(0.02));
  CHECK(levels.low_grey == 60);
  CHECK(levels.high_grey == 180);
}

TEST_CASE("a constant picture has no features, whatever its shape") {
  CHECK(levels_of(GreyImage(1, 1, 9)).feature_px == 0.0);
  const PictureLevels levels = levels_of(GreyImage(3, 5, 200));
  CHECK(levels.rms_grey == 0.0);
  CHECK(levels.mean_grey == 200.0);
  CHECK(levels.feature_px == 0.0);
}

TEST_CASE("equalising gives every picture the same mean and rms, and clips next to nothing") {
  const std::vector<GreyImage> pictures = {wave(64, 16, 70, 50), wave(64, 8, 128, 120),
                                           wave(64, 32, 200, 10)};
  std::vector<PictureLevels> set;
  for (const GreyImage& picture : pictures) set.push_back(levels_of(picture));
  for (const LevelEqualising which :
       {LevelEqualising::mean, LevelEqualising::rms, LevelEqualising::both}) {
    const EqualLevels wanted = equal_levels(set, which);
    CHECK(wanted.mean_grey.has_value() == (which != LevelEqualising::rms));
    CHECK(wanted.rms_grey.has_value() == (which != LevelEqualising::mean));
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const EqualisedPicture result = equalise_picture(pictures[i], set[i], wanted);
      const PictureLevels after = levels_of(result.picture);
      CHECK(after.mean_grey == Approx(wanted.mean_grey.value_or(set[i].mean_grey)).margin(0.5));
      CHECK(after.rms_grey == Approx(wanted.rms_grey.value_or(set[i].rms_grey)).margin(0.5));
      CHECK(result.clipped_share <= 2 * kTailShare);
    }
  }
}

TEST_CASE("equal contrast is reduced where a picture has no room for more") {
  const std::vector<PictureLevels> set = {levels_of(wave(64, 16, 128, 100)),
                                          levels_of(wave(64, 16, 128, 100)),
                                          levels_of(wave(64, 16, 240, 5))};
  const EqualLevels wanted = equal_levels(set, LevelEqualising::rms);
  CHECK(*wanted.rms_grey < 15.0);
  CHECK(*wanted.rms_grey > 5.0);
  CHECK(*equal_levels(set, LevelEqualising::both).rms_grey == Approx(set[0].rms_grey));
}

TEST_CASE("samples that shifting the mean clips are counted") {
  const GreyImage picture = wave(64, 16, 10, 10);
  const EqualisedPicture result =
      equalise_picture(picture, levels_of(picture), {.mean_grey = 250.0, .rms_grey = {}});
  CHECK(result.clipped_share > 0.2);
  CHECK(result.clipped_share < 0.5);
}
