// 16-bit pictures over their full range, from the file to the texture.
#include "engine/finite_plane.hpp"
#include "engine/image_file.hpp"
#include "engine/image_samples.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <cstdint>

namespace touchtrial {
namespace {

/// Every 16-bit level once, in rows of 256.
cv::Mat all_levels() {
  cv::Mat picture(256, 256, CV_16UC1);
  for (int i = 0; i < 65536; ++i) {
    picture.at<std::uint16_t>(i / 256, i % 256) = static_cast<std::uint16_t>(i);
  }
  return picture;
}

Bytes binary_pgm(const cv::Mat& picture) {
  Bytes file = samples::text("P5 256 256 65535\n");
  for (int i = 0; i < 65536; ++i) {
    const std::uint16_t level = picture.at<std::uint16_t>(i / 256, i % 256);
    file.push_back(static_cast<std::uint8_t>(level >> 8U));
    file.push_back(static_cast<std::uint8_t>(level & 255U));
  }
  return file;
}

TEST_CASE("every 16-bit level becomes its nearest 8-bit level, from every kind of file") {
  const cv::Mat picture = all_levels();
  for (const Bytes& file : {samples::encoded(".png", picture), samples::encoded(".tif", picture),
                            binary_pgm(picture)}) {
    const GreyImage image = samples::read_bytes(file);
    for (int i = 0; i < 65536; ++i) {
      REQUIRE(image.at(i / 256, i % 256) == static_cast<int>(std::floor(i / 257.0 + 0.5)));
    }
  }
}

TEST_CASE("16-bit noise and steps over the full range have textures like any other") {
  cv::Mat picture = all_levels();
  for (int i = 0; i < 65536; ++i) {
    // An odd factor visits every level once, far from its neighbours.
    picture.at<std::uint16_t>(i / 256, i % 256) = static_cast<std::uint16_t>(i * 40503U);
  }
  const GreyImage image = samples::read_bytes(samples::encoded(".png", picture));
  in_both_precisions([&]<typename Real>() {
    for (const engine::Method method :
         {engine::Method::adaptive, engine::Method::fixed, engine::Method::gaussian}) {
      engine::ExtractionOptions options;
      options.method = method;
      const auto result =
          engine::extract_texture<Real>(image, options, engine::WantedPlanes::all());
      CHECK(engine::all_finite(result.texture));
      CHECK(engine::all_finite(result.force.x));
    }
  });
}

}  // namespace
}  // namespace touchtrial
