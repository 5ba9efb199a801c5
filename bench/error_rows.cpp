// The budgets of single precision, on every SIMD target: no times.
#include "bench/inputs.hpp"
#include "bench/rows.hpp"
#include "engine/metrics/ssim.hpp"
#include "tests/engine/simd/targets.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial::bench {
namespace {

constexpr int kHardRadii[] = {1, 2, 3, 7, 63};

/// The largest number that a comparison of single precision with the truth gives on any target.
/// \param difference  of a truth and a float extraction
template <class Difference>
double largest_on_targets(const GreyImage& image, int radius, const Scope& scope,
                          Difference difference) {
  const ExtractionTruth truth(image, radius);
  engine::ExtractionOptions options;
  options.radius = radius;
  engine::WantedPlanes wanted;
  wanted.picture = true;
  double largest = 0.0;
  for (const std::string& target : scope.simd_targets) {
    force_simd_target(target);
    const auto result = engine::extract_texture<float>(image, options, wanted);
    largest = std::max<double>(largest, difference(truth, result));
  }
  return largest;
}

double texture_error(const ExtractionTruth& truth, const engine::Extraction<float>& result) {
  return truth.texture_error(result.texture);
}

double unlike_pixels(const ExtractionTruth& truth, const engine::Extraction<float>& result) {
  return truth.unlike_pixels(result.picture);
}

template <class Difference>
double largest_on_pictures(const Scope& scope, Difference difference) {
  double largest = 0.0;
  for (const GreyImage& image : shipped_pictures()) {
    largest = std::max(largest, largest_on_targets(image, kUsualRadius, scope, difference));
  }
  return largest;
}

double error_on_hard_images(const Scope& scope) {
  double largest = 0.0;
  for (const GreyImage& image : hard_images()) {
    for (const int radius : kHardRadii) {
      largest = std::max(largest, largest_on_targets(image, radius, scope, texture_error));
    }
  }
  return largest;
}

double ms_ssim_error(const GreyImage& a, const GreyImage& b) {
  return std::abs(engine::ms_ssim<float>(a, b).unit - engine::ms_ssim<double>(a, b).unit);
}

double ms_ssim_error_on_textures() {
  engine::ExtractionOptions fixed;
  fixed.method = engine::Method::fixed;
  fixed.order = kFixedOrder;
  double largest = 0.0;
  for (const GreyImage& image : shipped_pictures()) {
    const auto adaptive = engine::extract_texture<float>(image, {});
    largest =
        std::max(largest, ms_ssim_error(engine::texture_picture(adaptive.texture),
                                        engine::texture_picture(
                                            engine::extract_texture<float>(image, fixed).texture)));
  }
  return largest;
}

double ms_ssim_error_on_hard_images() {
  const std::vector<GreyImage> hard = hard_images();
  double largest = 0.0;
  for (std::size_t i = 0; i < hard.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      largest = std::max(largest, ms_ssim_error(hard[i], hard[j]));
    }
  }
  return largest;
}

Row error_row(const std::string& what, const std::string& unit, double target,
              const std::function<double()>& error) {
  Case ours{"touchtrial", [=] { return Job{.run = {}, .error = error}; }};
  ours.clock = Clock::none;
  return {.what = what, .ours = ours, .goal = {"error", target}, .error_unit = unit};
}

}  // namespace

Rows error_rows(const Scope& scope) {
  return {error_row("texture, pictures, K = 2", "grey levels", 2e-5,
                    [=] { return largest_on_pictures(scope, texture_error); }),
          {.what = "pixels of 8-bit textures that differ from double's",
           .ours = counted("touchtrial", [=] { return largest_on_pictures(scope, unlike_pixels); }),
           .goal = {"count", 0},
           .count_unit = "pixels"},
          error_row("texture, hard images, K = 1 .. 63", "grey levels", 4e-5,
                    [=] { return error_on_hard_images(scope); }),
          error_row("MS-SSIM, textures", "of MS-SSIM", 2e-7, ms_ssim_error_on_textures),
          error_row("MS-SSIM, steps and other hard images", "of MS-SSIM", 1e-4,
                    ms_ssim_error_on_hard_images)};
}

}  // namespace touchtrial::bench
