// 16-bit pictures over their full range, from the file to the texture.
#include "engine/extraction.hpp"
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
samples::Raster all_levels() {
  samples::Raster picture{256, 256, 1, 16, {}};
  for (std::uint32_t i = 0; i < 65536; ++i) {
    picture.samples.push_back(static_cast<std::uint16_t>(i));
  }
  return picture;
}

TEST_CASE("every 16-bit level becomes its nearest 8-bit level, from every kind of file") {
  const samples::Raster picture = all_levels();
  for (const Bytes& file :
       {samples::png_file(picture), samples::tiff_file(picture), samples::ppm_file(picture)}) {
    const GreyImage image = samples::read_bytes(file);
    for (int i = 0; i < 65536; ++i) {
      REQUIRE(image.at(i / 256, i % 256) == static_cast<int>(std::floor(i / 257.0 + 0.5)));
    }
  }
}

TEST_CASE("16-bit pictures over the full range have finite textures") {
  samples::Raster picture = all_levels();
  for (std::uint32_t i = 0; i < 65536; ++i) {
    // An odd factor visits every level once, far from its neighbours.
    picture.samples[i] = static_cast<std::uint16_t>(i * 40503U);
  }
  const GreyImage image = samples::read_bytes(samples::png_file(picture));
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
