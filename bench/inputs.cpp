#include "bench/inputs.hpp"

#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "engine/symmetric_extension.hpp"
#include "stimuli/generator.hpp"
#include "tests/engine/reference/extraction_reference.hpp"
#include "tests/engine/reference/tv_gabor_course.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace touchtrial::bench {
namespace {

constexpr int kHardSize_px = 256;
constexpr double kTieWidth_grey = 1e-4;
/// After these steps the gap is below 1e-7 on pictures, and v is exact to about 1e-4.
constexpr int kTvGaborSteps = 400;

GreyImage stimulus(const std::string& name) {
  return engine::read_grey_image(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "stimuli" /
                                 (name + ".png"));
}

template <typename LevelAt>
GreyImage drawn(LevelAt level_at) {
  GreyImage image(kHardSize_px, kHardSize_px);
  for (int y = 0; y < kHardSize_px; ++y) {
    for (int x = 0; x < kHardSize_px; ++x) {
      image.at(y, x) = static_cast<std::uint8_t>(level_at(y, x));
    }
  }
  return image;
}

GreyImage& chosen_picture() {
  static GreyImage picture = stimulus("bark");
  return picture;
}

engine::Extraction<double> extracted(const GreyImage& image, int radius) {
  engine::ExtractionOptions options;
  options.radius = radius;
  engine::WantedPlanes wanted;
  wanted.csgv = true;
  wanted.picture = true;
  return engine::extract_texture<double>(image, options, wanted);
}

bool is_near_tie(double texture) {
  const double above = texture + 0.5 - std::floor(texture + 0.5);
  return std::min(above, 1.0 - above) < kTieWidth_grey;
}

}  // namespace

std::vector<GreyImage> shipped_pictures(bool only_filled) {
  std::vector<GreyImage> pictures;
  std::vector<GreyImage> objects;
  for (const stimuli::StimulusRecipe& recipe : stimuli::stimulus_recipes()) {
    if (recipe.kind == stimuli::StimulusKind::flat) continue;
    const bool is_object = recipe.kind == stimuli::StimulusKind::object;
    (is_object ? objects : pictures).push_back(stimulus(std::string(recipe.label)));
  }
  if (!only_filled) pictures.insert(pictures.end(), objects.begin(), objects.end());
  return pictures;
}

std::vector<GreyImage> hard_images() {
  RandomStream random(1, "benchmark noise");
  constexpr int kMiddle = kHardSize_px / 2;
  return {drawn([&](int, int) { return random.below(256); }),
          drawn([](int, int x) { return x < kMiddle ? 0 : 255; }),
          drawn([](int y, int x) { return (x + y) % 2 * 255; }),
          drawn([](int y, int x) { return y == kMiddle && x == kMiddle ? 255 : 0; }),
          drawn([](int, int x) { return 4 * x % 256; })};
}

GreyImage timed_image(int size_px) {
  const GreyImage& picture = chosen_picture();
  GreyImage square(size_px, size_px);
  for (int y = 0; y < size_px; ++y) {
    const auto from = picture.row(engine::symmetric_index(y, picture.height()));
    for (int x = 0; x < size_px; ++x) {
      square.at(y, x) = from[static_cast<std::size_t>(engine::symmetric_index(x, picture.width()))];
    }
  }
  return square;
}

void choose_timed_picture(const std::filesystem::path& path) {
  chosen_picture() = engine::read_grey_image(path);
}

ExtractionTruth::ExtractionTruth(const GreyImage& image, int radius)
    : truth_(extracted(image, radius)) {}

double ExtractionTruth::texture_error(const Plane<float>& texture) const {
  if (texture.size() != truth_.texture.size()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t i = 0; i < texture.size(); ++i) {
    if (reference::is_at_branch_point(truth_.csgv.samples()[i])) continue;
    const double error = std::abs(texture.samples()[i] - truth_.texture.samples()[i]);
    largest =
        std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(largest, error);
  }
  return largest;
}

int ExtractionTruth::unlike_pixels(const GreyImage& picture) const {
  int unlike = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const bool differs = picture.samples()[i] != truth_.picture.samples()[i];
    unlike += differs && !reference::is_at_branch_point(truth_.csgv.samples()[i]) &&
                      !is_near_tie(truth_.texture.samples()[i])
                  ? 1
                  : 0;
  }
  return unlike;
}

Plane<double> tv_gabor_truth(const GreyImage& image) {
  reference::TvGaborCourse<double> course(image, {}, reference::TvGaborAlgorithm::admm);
  course.advance(kTvGaborSteps);
  return course.point().texture;
}

}  // namespace touchtrial::bench
