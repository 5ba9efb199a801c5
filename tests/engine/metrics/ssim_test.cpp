#include "engine/metrics/ssim.hpp"

#include "engine/every_simd_target.hpp"
#include "engine/example_images.hpp"
#include "engine/reference/ssim_reference.hpp"
#include "engine/refusal.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <cstddef>

namespace touchtrial {
namespace {

constexpr double kC1 = 0.01 * 255 * 0.01 * 255;
constexpr double kC2 = 0.03 * 255 * 0.03 * 255;
constexpr double kDoubleTolerance = 1e-11;
/// What floats promise on textures, and on any images.
constexpr double kTextureTolerance = 2e-7;
constexpr double kAnyTolerance = 2e-5;

/// The smallest, odd ones, and those around the width of a tile in floats and in doubles.
const std::vector<Size> kSizes = {{11, 11}, {11, 12}, {12, 11},  {13, 29},  {64, 63},
                                  {11, 74}, {15, 75}, {12, 138}, {11, 139}, {37, 271}};

/// Another state of the same texture: less contrast, and noise.
GreyImage worn(const GreyImage& image) {
  GreyImage result = image;
  const GreyImage noise = noise_image({image.height(), image.width()}, 7);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result.samples()[i] =
        static_cast<std::uint8_t>(30 + image.samples()[i] * 3 / 4 + noise.samples()[i] / 16);
  }
  return result;
}

template <typename Visit>
void for_each_pair(Size size, const Visit& visit) {
  const std::vector<NamedImage> images = example_images(size);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const NamedImage& other = images[(i + 1) % images.size()];
    INFO(images[i].name << " and " << other.name << ", " << size.height << " x " << size.width);
    visit(images[i].image, other.image);
    visit(images[i].image, worn(images[i].image));
    visit(images[i].image, negative_of(images[i].image));
  }
}

TEMPLATE_TEST_CASE("ssim of an image and itself is exactly 1", "", float, double) {
  on_every_simd_target([] {
    for (const Size size : kSizes) {
      for (const auto& [name, image] : example_images(size)) {
        INFO(name);
        CHECK(engine::ssim<TestType>(image, image) == 1.0);
      }
    }
  });
}

TEMPLATE_TEST_CASE("ssim of different images is below 1, however little they differ", "", float,
                   double) {
  on_every_simd_target([] {
    const GreyImage image = cloth_image({120, 150});
    GreyImage other = image;
    ++other.at(60, 60);
    CHECK(engine::ssim<TestType>(image, other) < 1.0);
    CHECK(engine::ssim<TestType>(image, other) > 1.0 - 1e-5);
  });
}

TEMPLATE_TEST_CASE("ssim does not care which image comes first", "", float, double) {
  on_every_simd_target([] {
    for_each_pair({23, 143}, [](const GreyImage& a, const GreyImage& b) {
      CHECK(engine::ssim<TestType>(a, b) == engine::ssim<TestType>(b, a));
    });
  });
}

TEMPLATE_TEST_CASE("ssim stays within -1 and 1", "", float, double) {
  for_each_pair({40, 41}, [](const GreyImage& a, const GreyImage& b) {
    CHECK(std::abs(engine::ssim<TestType>(a, b)) <= 1.0);
  });
}

TEMPLATE_TEST_CASE("ssim of two flat images is their l", "", float, double) {
  on_every_simd_target([] {
    for (const auto& [a, b] : {std::pair{0, 255}, {100, 101}, {7, 200}}) {
      const double l = (2.0 * a * b + kC1) / (a * a + b * b + kC1);
      const double tolerance = sizeof(TestType) == sizeof(float) ? 3e-7 : 1e-14;
      CHECK(std::abs(engine::ssim<TestType>(flat_image({30, 31}, a), flat_image({30, 31}, b)) - l) <
            tolerance);
    }
  });
}

TEST_CASE("ssim of a checkerboard and its negative follows from its window") {
  double alternating = 0.0;  // the window's weighted mean of +1 and -1 by turns
  const auto window = reference::ssim_window();
  for (std::size_t j = 0; j < window.size(); ++j) {
    for (std::size_t i = 0; i < window.size(); ++i) {
      alternating += (i + j) % 2 == 0 ? window[j][i] : -window[j][i];
    }
  }
  const double power = 127.5 * 127.5;
  const double shift = alternating * alternating;
  const double l = (2 * power * (1 - shift) + kC1) / (2 * power * (1 + shift) + kC1);
  const double cs = (-2 * power * (1 - shift) + kC2) / (2 * power * (1 - shift) + kC2);
  on_every_simd_target([&] {
    const GreyImage board = checkerboard({40, 150});
    CHECK(engine::ssim<double>(board, negative_of(board)) == Approx(l * cs).epsilon(1e-12));
    CHECK(std::abs(engine::ssim<float>(board, negative_of(board)) - l * cs) < 1e-5);
  });
}

TEST_CASE("ssim agrees with its definition on every pair, size and target") {
  for (const Size size : kSizes) {
    for_each_pair(size, [](const GreyImage& a, const GreyImage& b) {
      const double expected = reference::similarity(converted<double>(a), converted<double>(b)).lcs;
      on_every_simd_target([&] {
        CHECK(std::abs(engine::ssim<double>(a, b) - expected) < kDoubleTolerance);
        CHECK(std::abs(engine::ssim<float>(a, b) - expected) < kAnyTolerance);
      });
    });
  }
}

TEST_CASE("ssim refuses images of different or too small sizes") {
  CHECK(refusal_of([] { (void)engine::ssim<float>(GreyImage(20, 21), GreyImage(20, 20)); }) ==
        "ssim: the images differ in size, 20 x 21 and 20 x 20 pixels");
  CHECK(refusal_of([] { (void)engine::ssim<float>(GreyImage(10, 21), GreyImage(10, 21)); }) ==
        "ssim: the images are 10 x 21 pixels, and both sides must be at least 11");
  CHECK_FALSE(refusal_of([] { (void)engine::ssim<double>(GreyImage(), GreyImage()); }).empty());
}

TEMPLATE_TEST_CASE("ms_ssim of an image and itself is exactly 1", "", float, double) {
  on_every_simd_target([] {
    for (const Size size : {Size{161, 161}, Size{161, 300}, Size{175, 163}}) {
      for (const auto& [name, image] : example_images(size)) {
        INFO(name);
        const engine::MsSsim same = engine::ms_ssim<TestType>(image, image);
        CHECK(same.unit == 1.0);
        CHECK(same.wang == 1.0);
      }
    }
  });
}

TEMPLATE_TEST_CASE("ms_ssim does not care which image comes first", "", float, double) {
  on_every_simd_target([] {
    for_each_pair({163, 170}, [](const GreyImage& a, const GreyImage& b) {
      const engine::MsSsim forwards = engine::ms_ssim<TestType>(a, b);
      const engine::MsSsim backwards = engine::ms_ssim<TestType>(b, a);
      CHECK(forwards.unit == backwards.unit);
      CHECK(forwards.wang == backwards.wang);
      CHECK(std::abs(forwards.unit) <= 1.0);
      CHECK(forwards.wang >= 0.0);
      CHECK(forwards.wang <= 1.0);
    });
  });
}

TEST_CASE("ms_ssim of two flat images is l of the last scale") {
  const double l = (2.0 * 90 * 120 + kC1) / (90 * 90 + 120 * 120 + kC1);
  on_every_simd_target([&] {
    const engine::MsSsim result =
        engine::ms_ssim<double>(flat_image({161, 162}, 90), flat_image({161, 162}, 120));
    CHECK(result.unit == Approx(l).epsilon(1e-14));
    CHECK(result.wang == Approx(std::pow(l, 0.1333)).epsilon(1e-14));
  });
}

TEST_CASE("ms_ssim counts a negative mean as it is with unit exponents, as 0 with Wang's") {
  const GreyImage board = checkerboard({162, 176});  // flat from the second scale on
  const engine::MsSsim result = engine::ms_ssim<double>(board, negative_of(board));
  CHECK(result.unit < -0.99);
  CHECK(result.wang == 0.0);
}

TEST_CASE("ms_ssim agrees with its definition on every pair and target") {
  for_each_pair({161, 171}, [](const GreyImage& a, const GreyImage& b) {
    const reference::MsSsim expected = reference::ms_ssim(a, b);
    on_every_simd_target([&] {
      const engine::MsSsim exact = engine::ms_ssim<double>(a, b);
      CHECK(std::abs(exact.unit - expected.unit) < kDoubleTolerance);
      CHECK(std::abs(exact.wang - expected.wang) < kDoubleTolerance);
      CHECK(std::abs(engine::ms_ssim<float>(a, b).unit - expected.unit) < kAnyTolerance);
      CHECK(std::abs(engine::ms_ssim<float>(a, b).wang - expected.wang) < kAnyTolerance);
    });
  });
}

TEST_CASE("ms_ssim in floats keeps its precision on textures") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const GreyImage texture = cloth_image({500, 499}, seed);
    for (const GreyImage& other : {worn(texture), cloth_image({500, 499}, seed + 1)}) {
      on_every_simd_target([&] {
        const engine::MsSsim exact = engine::ms_ssim<double>(texture, other);
        const engine::MsSsim quick = engine::ms_ssim<float>(texture, other);
        CHECK(std::abs(quick.unit - exact.unit) < kTextureTolerance);
        CHECK(std::abs(quick.wang - exact.wang) < kTextureTolerance);
      });
    }
  }
}

TEST_CASE("ms_ssim refuses images of different or too small sizes") {
  CHECK(refusal_of([] {
          (void)engine::ms_ssim<float>(GreyImage(200, 210), GreyImage(210, 200));
        }) == "ms_ssim: the images differ in size, 200 x 210 and 210 x 200 pixels");
  CHECK(refusal_of([] {
          (void)engine::ms_ssim<float>(GreyImage(500, 160), GreyImage(500, 160));
        }) == "ms_ssim: the images are 500 x 160 pixels, and both sides must be at least 161");
}

}  // namespace
}  // namespace touchtrial
