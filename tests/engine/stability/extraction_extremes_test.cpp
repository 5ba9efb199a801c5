// Every extractor on every extreme image is finite, bounded and deterministic, and obeys its laws.
#include "engine/extraction.hpp"
#include "engine/finite_plane.hpp"
#include "engine/gl_texture.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace touchtrial {
namespace {

template <typename Real>
Plane<Real> texture_of(const GreyImage& image, const engine::ExtractionOptions& options) {
  return engine::extract_texture<Real>(image, options).texture;
}

TEST_CASE("every texture of every extreme image is finite, bounded and the same each time") {
  for_every_extreme([]<typename Real>(const ExtractionCase& extraction, const GreyImage& image) {
    const auto result =
        engine::extract_texture<Real>(image, extraction.options, engine::RequestedPlanes::all());
    REQUIRE(engine::all_finite(result.texture));
    REQUIRE(largest_magnitude(result.texture) <= extraction.largest_texture);
    REQUIRE(engine::all_finite(result.force.x));
    REQUIRE(engine::all_finite(result.force.y));
    REQUIRE(texture_of<Real>(image, extraction.options) == result.texture);
  });
}

/// The largest |T| - 255 (1 - S_K); infinite if an order is outside [0, 1).
template <typename Real>
double excess_over_bound(const engine::Extraction<Real>& result, int radius) {
  double excess = -255.0;
  for (std::size_t i = 0; i < result.order.size(); ++i) {
    const auto order = static_cast<double>(result.order.samples()[i]);
    if (!(order >= 0.0 && order < 1.0)) return std::numeric_limits<double>::infinity();
    const double bound = 255.0 * (1.0 - engine::gl_weight_sum(order, radius));
    const auto texture = static_cast<double>(result.texture.samples()[i]);
    excess = std::max(excess, std::abs(texture) - bound);
  }
  return excess;
}

TEST_CASE("every order of an extreme image lies in 0 to 1, and its texture within 255 (1 - S_K)") {
  engine::RequestedPlanes wanted{.order = true};
  for_every_extreme([&]<typename Real>(const ExtractionCase& extraction, const GreyImage& image) {
    const engine::ExtractionOptions& options = extraction.options;
    if (options.method != engine::Method::adaptive || options.norm != engine::Norm::additive)
      return;
    const auto result = engine::extract_texture<Real>(image, options, wanted);
    REQUIRE(excess_over_bound(result, options.radius) <= 4e-5);
  });
}

TEST_CASE("every extractor but luminance keeps a flat image exactly flat") {
  in_both_precisions([]<typename Real>() {
    for (const ExtractionCase& extraction : extraction_cases()) {
      if (extraction.options.method == engine::Method::luminance) continue;
      for (const int level : {0, 128, 255}) {
        INFO(extraction.name << ", level " << level);
        const GreyImage image = flat_image({7, 21}, level);
        CHECK(largest_magnitude(texture_of<Real>(image, extraction.options)) == 0.0);
      }
    }
  });
}

/// How much two computations of one texture may differ by rounding, in grey levels.
template <typename Real>
double tolerance(const ExtractionCase& extraction) {
  const double digits = std::is_same_v<Real, float> ? 2e-7 : 1e-12;
  return digits * std::max(255.0, extraction.largest_texture);
}

/// Whether a negative has the negative texture. Edge ignores the sign; luminance reflects at 127.5
/// instead of 128.
bool is_odd(const ExtractionCase& extraction) {
  return extraction.options.method != engine::Method::edge &&
         extraction.options.method != engine::Method::luminance;
}

/// Whether no CSGV is near a branch point of the order map, where rounding could change the order.
bool has_clear_branches(const GreyImage& image, const engine::ExtractionOptions& options) {
  if (options.method != engine::Method::adaptive) return true;
  engine::RequestedPlanes wanted{.csgv = true};
  const auto csgv = engine::extract_texture<double>(image, options, wanted).csgv;
  return std::ranges::none_of(csgv.samples(), reference::is_at_branch_point);
}

TEST_CASE("the negative of an extreme image has the negative texture") {
  int compared = 0;
  for_every_extreme([&]<typename Real>(const ExtractionCase& extraction, const GreyImage& image) {
    if (!is_odd(extraction) || !has_clear_branches(image, extraction.options)) return;
    Plane<Real> negative = texture_of<Real>(negative_of(image), extraction.options);
    for (Real& sample : negative.samples()) sample = -sample;
    REQUIRE(largest_difference(negative, texture_of<Real>(image, extraction.options)) <=
            tolerance<Real>(extraction));
    ++compared;
  });
  CHECK(compared > 5000);
}

TEST_CASE("no extractor but luminance depends on the brightness of an extreme image") {
  for_every_extreme([]<typename Real>(const ExtractionCase& extraction, const GreyImage& image) {
    if (extraction.options.method == engine::Method::luminance) return;
    const GreyImage dark = rescaled(image, 2, 0);
    if (!has_clear_branches(dark, extraction.options)) return;
    REQUIRE(largest_difference(texture_of<Real>(rescaled(image, 2, 100), extraction.options),
                               texture_of<Real>(dark, extraction.options)) <=
            tolerance<Real>(extraction));
  });
}

}  // namespace
}  // namespace touchtrial
