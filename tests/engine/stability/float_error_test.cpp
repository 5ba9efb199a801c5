// How much textures, pictures and MS-SSIM may differ between single precision and double.
#include "engine/extraction.hpp"
#include "engine/metrics/ssim.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial {
namespace {

constexpr double kTextureTolerance = 4e-5;  // grey levels, on any 8-bit image and radius

bool is_near_tie(double texture) {
  const double fraction = texture - std::floor(texture);
  return std::abs(fraction - 0.5) < 1e-4;
}

/// The exceptions from the promise of equal pictures, counted.
struct Comparison {
  std::size_t pixels = 0;
  std::size_t at_branch_point = 0;
  std::size_t differ_at_tie = 0;
};

void compare(const GreyImage& image, int radius, Comparison& counts) {
  engine::ExtractionOptions options{.radius = radius};
  engine::RequestedPlanes wanted;
  wanted.csgv = wanted.picture = true;
  const auto truth = engine::extract_texture<double>(image, options, wanted);
  const auto single = engine::extract_texture<float>(image, options, wanted);
  for (std::size_t i = 0; i < image.size(); ++i) {
    ++counts.pixels;
    if (reference::is_at_branch_point(truth.csgv.samples()[i])) {
      ++counts.at_branch_point;
      continue;
    }
    const double texture = truth.texture.samples()[i];
    REQUIRE(std::abs(single.texture.samples()[i] - texture) < kTextureTolerance);
    if (single.picture.samples()[i] == truth.picture.samples()[i]) continue;
    REQUIRE(is_near_tie(texture));
    ++counts.differ_at_tie;
  }
}

TEST_CASE("8-bit textures of both precisions are equal except at branch points and ties") {
  on_every_simd_target([] {
    Comparison noisy;
    Comparison smooth;
    for (const int radius : {1, 2, 3, 7, 20, engine::ExtractionOptions::kMaxRadius}) {
      for (const Size size : {Size{3, 5}, Size{33, 35}, Size{120, 161}}) {
        INFO("radius " << radius << ", " << size.height << " x " << size.width);
        compare(noise_image(size), radius, noisy);
        compare(speckle_image(size), radius, noisy);
        compare(cloth_image(size), radius, smooth);
      }
    }
    // The exceptions are rare.
    CHECK(noisy.at_branch_point * 1000 < noisy.pixels);
    CHECK(noisy.differ_at_tie * 1000 < noisy.pixels);
    CHECK(smooth.at_branch_point * 100 < smooth.pixels);
    CHECK(smooth.differ_at_tie * 1000 < smooth.pixels);
  });
}

double ms_ssim_error(const GreyImage& a, const GreyImage& b) {
  const engine::MsSsim exact = engine::ms_ssim<double>(a, b);
  const engine::MsSsim single = engine::ms_ssim<float>(a, b);
  return std::max(std::abs(single.unit - exact.unit), std::abs(single.wang - exact.wang));
}

TEST_CASE("MS-SSIM of extreme images in single precision is within 1e-4 of double") {
  const std::vector<NamedImage> images = extreme_images({161, 178});
  on_every_simd_target([&] {
    for (const auto& [name, image] : images) {
      for (const auto& [other_name, other] : images) {
        INFO(name << " and " << other_name);
        CHECK(ms_ssim_error(image, other) < 1e-4);
      }
    }
  });
}

}  // namespace
}  // namespace touchtrial
