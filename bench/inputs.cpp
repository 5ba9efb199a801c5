#include "bench/inputs.hpp"

#include "engine/image_file.hpp"
#include "engine/symmetric_extension.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "stimuli/generator.hpp"
#include "tests/engine/reference/extraction_reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace touchtrial::bench {
namespace {

/// After these steps the gap is below 1e-7 on pictures, and v is exact to about 1e-4.
constexpr int kTvGaborSteps = 400;

GreyImage stimulus(const std::string& name) {
  return engine::read_grey_image(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "stimuli" /
                                 (name + ".png"));
}

GreyImage& chosen_picture() {
  static GreyImage picture = stimulus("bark");
  return picture;
}

engine::Extraction<double> extraction_of(const GreyImage& image, int radius) {
  engine::ExtractionOptions options;
  options.radius = radius;
  engine::RequestedPlanes planes;
  planes.csgv = true;
  return engine::extract_texture<double>(image, options, planes);
}

}  // namespace

std::vector<GreyImage> shipped_pictures() {
  std::vector<GreyImage> pictures;
  for (const stimuli::StimulusRecipe& recipe : stimuli::stimulus_recipes()) {
    const bool fills_frame =
        recipe.kind != stimuli::StimulusKind::flat && recipe.kind != stimuli::StimulusKind::object;
    if (fills_frame) pictures.push_back(stimulus(std::string(recipe.label)));
  }
  return pictures;
}

GreyImage timed_image(int size_px) {
  const GreyImage& picture = chosen_picture();
  GreyImage square(size_px, size_px);
  for (int y = 0; y < size_px; ++y) {
    const auto row = picture.row(engine::symmetric_index(y, picture.height()));
    for (int x = 0; x < size_px; ++x) {
      square.at(y, x) = row[static_cast<std::size_t>(engine::symmetric_index(x, picture.width()))];
    }
  }
  return square;
}

void choose_timed_picture(const std::filesystem::path& path) {
  chosen_picture() = engine::read_grey_image(path);
}

ExtractionTruth::ExtractionTruth(const GreyImage& image, int radius)
    : truth_(extraction_of(image, radius)) {}

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

Plane<double> tv_gabor_truth(const GreyImage& image) {
  engine::TvGaborSolver<double> solver(image, kUnreachableGap);
  static_cast<void>(solver.run(kTvGaborSteps, engine::Patience::unlimited));
  return solver.texture();
}

}  // namespace touchtrial::bench
