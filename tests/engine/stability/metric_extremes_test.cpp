// Metrics of identical, flat and opposite pictures.
#include "engine/metrics/glcm.hpp"
#include "engine/metrics/picture_statistics.hpp"
#include "engine/metrics/ssim.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"

#include <cmath>

namespace touchtrial {
namespace {

constexpr Size kSize{161, 173};

/// The extreme images, a texture and its negative.
std::vector<NamedImage> compared_images(Size size) {
  std::vector<NamedImage> images = extreme_images(size);
  images.push_back({"cloth", cloth_image(size)});
  images.push_back({"negative cloth", negative_of(cloth_image(size))});
  return images;
}

TEST_CASE("MS-SSIM of two extreme images is finite, in range and independent of their order") {
  const std::vector<NamedImage> images = compared_images(kSize);
  in_both_precisions([&]<typename Real>() {
    for (std::size_t i = 0; i < images.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        INFO(images[i].name << " and " << images[j].name);
        const engine::MsSsim there = engine::ms_ssim<Real>(images[i].image, images[j].image);
        const engine::MsSsim back = engine::ms_ssim<Real>(images[j].image, images[i].image);
        CHECK(there.unit == back.unit);
        CHECK(there.wang == back.wang);
        CHECK(std::abs(there.unit) <= 1.0);
        CHECK(there.wang >= 0.0);
        CHECK(there.wang <= 1.0);
      }
    }
  });
}

TEST_CASE("entropy and co-occurrence statistics of a constant image are exact") {
  for (int level = 0; level < 256; ++level) {
    for (const Size size : {Size{2, 2}, Size{2, 3}, Size{3, 50}, Size{257, 255}}) {
      if (size.height > 3 && level % 127 > 1) continue;  // a large one takes long
      const GreyImage image = flat_image(size, level);
      CHECK(engine::entropy(image) == 0.0);
      for (const engine::GlcmStatistics& statistics : engine::glcm_statistics(image)) {
        CHECK(statistics.angular_second_moment == 1.0);
        CHECK(statistics.energy == 1.0);
        CHECK(statistics.entropy == 0.0);
        CHECK(statistics.contrast == 0.0);
        CHECK(statistics.correlation == 1.0);
      }
    }
  }
}

TEST_CASE("co-occurrence statistics of extreme images are finite and in range") {
  for (const Size size : {Size{2, 2}, Size{3, 5}, Size{2, 64}, Size{63, 2}, kSize}) {
    for (const auto& [name, image] : extreme_images(size)) {
      INFO(name << ", " << size.height << " x " << size.width);
      for (const engine::GlcmStatistics& statistics : engine::glcm_statistics(image)) {
        CHECK(statistics.angular_second_moment > 0.0);
        CHECK(statistics.angular_second_moment <= 1.0);
        CHECK(statistics.entropy >= 0.0);
        CHECK(statistics.entropy <= 2.0 * std::log(256.0));
        CHECK(statistics.contrast >= 0.0);
        CHECK(statistics.contrast <= 255.0 * 255.0);
        CHECK(std::abs(statistics.correlation) <= 1.0);
      }
    }
  }
}

}  // namespace
}  // namespace touchtrial
