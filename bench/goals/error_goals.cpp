#include "bench/cases/cases.hpp"
#include "bench/goals/goal.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/inputs/truth.hpp"
#include "bench/measure/simd_target.hpp"
#include "engine/extraction.hpp"
#include "engine/metrics/ssim.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial::bench {
namespace {

constexpr double kPictureTarget_grey = 2e-5;
constexpr double kAnyTarget_grey = 4e-5;
constexpr double kTextureSsimTarget = 2e-7;
constexpr double kHardSsimTarget = 1e-4;
constexpr int kHardSize_px = 256;
constexpr int kHardRadii[] = {1, 2, 3, 7, 63};

struct TextureErrors {
  double error_grey = 0.0;
  int unlike_pixels = 0;
};

/// Raises the errors to the largest over all targets.
void add_errors(const GreyImage& image, int radius, const std::vector<std::string>& targets,
                TextureErrors& errors) {
  const ExtractionTruth truth(image, radius, false);
  engine::ExtractionOptions options;
  options.radius = radius;
  engine::WantedPlanes wanted;
  wanted.picture = true;
  for (const std::string& target : targets) {
    const ForcedTarget forced(target);
    const auto result = engine::extract_texture<float>(image, options, wanted);
    errors.error_grey = std::max(errors.error_grey, truth.texture_error(result.texture));
    errors.unlike_pixels = std::max(errors.unlike_pixels, truth.unlike_pixels(result.picture));
  }
}

GoalResult error_result(const std::string& name, double error, const std::string& unit,
                        double target) {
  GoalResult result;
  result.goal = name;
  result.error = error;
  result.error_unit = unit;
  result.limit = Limit::error;
  result.target = target;
  return result;
}

std::vector<GoalResult> picture_errors(const std::vector<std::string>& targets) {
  TextureErrors errors;
  for (const Picture& picture : shipped_pictures()) {
    add_errors(picture.image, kUsualRadius, targets, errors);
  }
  GoalResult unlike;
  unlike.goal = "pixels of 8-bit textures that differ from double's";
  unlike.count = errors.unlike_pixels;
  unlike.count_unit = "pixels";
  unlike.limit = Limit::count;
  unlike.target = 0.0;
  return {error_result("texture, pictures, K = 2", errors.error_grey, "grey levels",
                       kPictureTarget_grey),
          unlike};
}

std::vector<GoalResult> hard_errors(const std::vector<std::string>& targets) {
  TextureErrors errors;
  for (const Picture& picture : hard_images(kHardSize_px)) {
    for (const int radius : kHardRadii) add_errors(picture.image, radius, targets, errors);
  }
  return {error_result("texture, hard images, K = 1 .. 63", errors.error_grey, "grey levels",
                       kAnyTarget_grey)};
}

double ms_ssim_error(const GreyImage& a, const GreyImage& b) {
  return std::abs(engine::ms_ssim<float>(a, b).unit - engine::ms_ssim<double>(a, b).unit);
}

std::vector<GoalResult> ms_ssim_errors() {
  double on_textures = 0.0;
  for (const Picture& picture : shipped_pictures()) {
    engine::ExtractionOptions options;
    const GreyImage adaptive =
        engine::texture_picture(engine::extract_texture<float>(picture.image, options).texture);
    options.method = engine::Method::fixed;
    options.order = kFixedOrder;
    const GreyImage fixed =
        engine::texture_picture(engine::extract_texture<float>(picture.image, options).texture);
    on_textures = std::max(on_textures, ms_ssim_error(adaptive, fixed));
  }
  const std::vector<Picture> hard = hard_images(kHardSize_px);
  double on_hard = 0.0;
  for (std::size_t i = 0; i < hard.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      on_hard = std::max(on_hard, ms_ssim_error(hard[i].image, hard[j].image));
    }
  }
  return {error_result("MS-SSIM, textures", on_textures, "", kTextureSsimTarget),
          error_result("MS-SSIM, steps and other hard images", on_hard, "", kHardSsimTarget)};
}

}  // namespace

std::vector<Goal> error_goals(const std::vector<std::string>& targets) {
  return {[=](const Effort&) { return picture_errors(targets); },
          [=](const Effort&) { return hard_errors(targets); },
          [](const Effort&) { return ms_ssim_errors(); }};
}

}  // namespace touchtrial::bench
