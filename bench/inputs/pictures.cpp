#include "bench/inputs/pictures.hpp"

#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "engine/symmetric_extension.hpp"
#include "stimuli/generator.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace touchtrial::bench {
namespace {

const std::filesystem::path kStimuli = std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "stimuli";

template <typename LevelAt>
Picture drawn(const std::string& name, int size_px, LevelAt level_at) {
  GreyImage image(size_px, size_px);
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      image.at(y, x) = static_cast<std::uint8_t>(level_at(y, x));
    }
  }
  return {name, false, std::move(image)};
}

GreyImage& chosen_picture() {
  static GreyImage picture = engine::read_grey_image(kStimuli / "bark.png");
  return picture;
}

}  // namespace

std::vector<Picture> shipped_pictures() {
  std::vector<Picture> pictures;
  for (const stimuli::StimulusRecipe& recipe : stimuli::stimulus_recipes()) {
    if (recipe.kind == stimuli::StimulusKind::flat) continue;
    const std::string label(recipe.label);
    pictures.push_back({label, recipe.kind == stimuli::StimulusKind::object,
                        engine::read_grey_image(kStimuli / (label + ".png"))});
  }
  std::stable_partition(pictures.begin(), pictures.end(),
                        [](const Picture& picture) { return !picture.has_ground; });
  return pictures;
}

std::vector<Picture> hard_images(int size_px) {
  RandomStream random(1, "benchmark noise");
  const int middle = size_px / 2;
  return {drawn("noise", size_px, [&](int, int) { return random.below(256); }),
          drawn("step", size_px, [=](int, int x) { return x < middle ? 0 : 255; }),
          drawn("checkerboard", size_px, [](int y, int x) { return (x + y) % 2 * 255; }),
          drawn("bright pixel", size_px,
                [=](int y, int x) { return y == middle && x == middle ? 255 : 0; }),
          drawn("ramp", size_px, [](int, int x) { return 4 * x % 256; })};
}

GreyImage square_of(const GreyImage& picture, int size_px) {
  GreyImage square(size_px, size_px);
  for (int y = 0; y < size_px; ++y) {
    const auto from = picture.row(engine::symmetric_index(y, picture.height()));
    for (int x = 0; x < size_px; ++x) {
      square.at(y, x) = from[static_cast<std::size_t>(engine::symmetric_index(x, picture.width()))];
    }
  }
  return square;
}

const GreyImage& timed_picture() {
  return chosen_picture();
}

void choose_timed_picture(const std::filesystem::path& path) {
  chosen_picture() = engine::read_grey_image(path);
}

}  // namespace touchtrial::bench
