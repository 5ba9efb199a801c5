#include "engine/metrics/glcm.hpp"

#include "engine/example_images.hpp"
#include "engine/reference/glcm_reference.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <cmath>
#include <cstddef>

namespace touchtrial {
namespace {

enum : std::size_t { kAt0, kAt45, kAt90, kAt135 };

GreyImage image_of(std::initializer_list<std::initializer_list<int>> rows) {
  GreyImage image(static_cast<int>(rows.size()), static_cast<int>(rows.begin()->size()));
  auto sample = image.samples().begin();
  for (const auto& row : rows) {
    for (const int level : row) *sample++ = static_cast<std::uint8_t>(level);
  }
  return image;
}

GreyImage transposed(const GreyImage& image) {
  GreyImage result(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) result.at(x, y) = image.at(y, x);
  }
  return result;
}

GreyImage mirrored_left_right(const GreyImage& image) {
  GreyImage result = image;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) result.at(y, x) = image.at(y, image.width() - 1 - x);
  }
  return result;
}

void check_same(const engine::GlcmStatistics& a, const engine::GlcmStatistics& b,
                double tolerance) {
  CHECK(std::abs(a.angular_second_moment - b.angular_second_moment) <= tolerance);
  CHECK(std::abs(a.energy - b.energy) <= tolerance);
  CHECK(std::abs(a.entropy - b.entropy) <= tolerance * 10);
  CHECK(std::abs(a.contrast - b.contrast) <= tolerance * 65025);
  CHECK(std::abs(a.correlation - b.correlation) <= tolerance * 10);
}

TEST_CASE("glcm_statistics of Haralick's example are the published counts") {
  const engine::GlcmTable table =
      engine::glcm_statistics(image_of({{0, 0, 1, 1}, {0, 0, 1, 1}, {0, 2, 2, 2}, {2, 2, 3, 3}}));
  CHECK(table[kAt0].angular_second_moment == Approx(84.0 / 576).epsilon(1e-15));
  CHECK(table[kAt0].contrast == Approx(14.0 / 24).epsilon(1e-15));
  CHECK(table[kAt45].angular_second_moment == Approx(48.0 / 324).epsilon(1e-15));
  CHECK(table[kAt45].contrast == Approx(8.0 / 18).epsilon(1e-15));
  CHECK(table[kAt90].angular_second_moment == Approx(80.0 / 576).epsilon(1e-15));
  CHECK(table[kAt90].contrast == Approx(24.0 / 24).epsilon(1e-15));
  CHECK(table[kAt135].angular_second_moment == Approx(38.0 / 324).epsilon(1e-15));
  CHECK(table[kAt135].contrast == Approx(32.0 / 18).epsilon(1e-15));
}

TEST_CASE("glcm_statistics of the smallest image agree with a count by hand") {
  const engine::GlcmTable table = engine::glcm_statistics(image_of({{0, 1}, {2, 3}}));
  CHECK(table[kAt0].angular_second_moment == 0.25);
  CHECK(table[kAt0].energy == 0.5);
  CHECK(table[kAt0].entropy == Approx(std::log(4.0)).epsilon(1e-15));
  CHECK(table[kAt0].contrast == 1.0);
  CHECK(table[kAt0].correlation == Approx(0.6).epsilon(1e-15));
  CHECK(table[kAt45].contrast == 1.0);  // 2 has 1 to its right and above it
  CHECK(table[kAt45].entropy == Approx(std::log(2.0)).epsilon(1e-15));
  CHECK(table[kAt45].correlation == -1.0);
  CHECK(table[kAt90].contrast == 4.0);
  CHECK(table[kAt135].contrast == 9.0);
}

TEST_CASE("glcm_statistics of a checkerboard distinguish straight and diagonal directions") {
  const engine::GlcmTable table = engine::glcm_statistics(checkerboard({20, 21}));
  for (const std::size_t straight : {kAt0, kAt90}) {
    CHECK(table[straight].contrast == 65025.0);
    CHECK(table[straight].correlation == -1.0);
    CHECK(table[straight].entropy == Approx(std::log(2.0)).epsilon(1e-14));
  }
  for (const std::size_t diagonal : {kAt45, kAt135}) {
    CHECK(table[diagonal].contrast == 0.0);
    CHECK(table[diagonal].correlation == 1.0);
  }
}

TEST_CASE("glcm_statistics agree with their definition on every image and size") {
  for (const Size size : {Size{2, 2}, Size{2, 17}, Size{17, 2}, Size{7, 4}, Size{64, 63}}) {
    for (const auto& [name, image] : example_images(size)) {
      INFO(name << ", " << size.height << " x " << size.width);
      const engine::GlcmTable table = engine::glcm_statistics(image);
      for (std::size_t d = 0; d < table.size(); ++d) {
        INFO(engine::kGlcmOffsets[d].degrees << " degrees");
        const engine::GlcmOffset& offset = engine::kGlcmOffsets[d];
        check_same(table[d], reference::glcm_statistics(image, offset.dy, offset.dx), 1e-13);
      }
    }
  }
}

TEST_CASE("glcm_statistics agree with their definition for counts beyond the table of logarithms") {
  GreyImage image = step_image({300, 301});
  image.at(150, 30) = 41;
  const engine::GlcmTable table = engine::glcm_statistics(image);
  for (std::size_t d = 0; d < table.size(); ++d) {
    const engine::GlcmOffset& offset = engine::kGlcmOffsets[d];
    check_same(table[d], reference::glcm_statistics(image, offset.dy, offset.dx), 1e-12);
  }
}

TEST_CASE("glcm_statistics of a negative are those of the image") {
  const GreyImage image = cloth_image({61, 50});
  const engine::GlcmTable table = engine::glcm_statistics(image);
  const engine::GlcmTable negative = engine::glcm_statistics(negative_of(image));
  for (std::size_t d = 0; d < table.size(); ++d) check_same(table[d], negative[d], 1e-14);
}

TEST_CASE("glcm_statistics turn with the image") {
  const GreyImage image = cloth_image({61, 50});
  const engine::GlcmTable table = engine::glcm_statistics(image);
  const engine::GlcmTable turned = engine::glcm_statistics(transposed(image));
  check_same(turned[kAt0], table[kAt90], 1e-14);
  check_same(turned[kAt45], table[kAt45], 1e-14);
  check_same(turned[kAt135], table[kAt135], 1e-14);
  const engine::GlcmTable mirrored = engine::glcm_statistics(mirrored_left_right(image));
  check_same(mirrored[kAt0], table[kAt0], 1e-14);
  check_same(mirrored[kAt45], table[kAt135], 1e-14);
  check_same(mirrored[kAt135], table[kAt45], 1e-14);
}

TEST_CASE("glcm_statistics refuse an image in which a direction has no pair") {
  CHECK_THAT(
      message_of<std::invalid_argument>([] { (void)engine::glcm_statistics(GreyImage(1, 9)); }),
      names("glcm_statistics 1 9 2"));
  CHECK_FALSE(message_of<std::invalid_argument>([] {
                (void)engine::glcm_statistics(GreyImage(9, 1));
              }).empty());
  CHECK_FALSE(message_of<std::invalid_argument>([] {
                (void)engine::glcm_statistics(GreyImage());
              }).empty());
}

}  // namespace
}  // namespace touchtrial
