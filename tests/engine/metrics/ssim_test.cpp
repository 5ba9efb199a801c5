#include "engine/metrics/ssim.hpp"

#include "engine/every_simd_target.hpp"
#include "engine/example_images.hpp"
#include "engine/metrics/ssim_deficits.hpp"
#include "engine/reference/ssim_reference.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <cmath>
#include <cstddef>

namespace touchtrial {
namespace {

constexpr double kC1 = 0.01 * 255 * 0.01 * 255;
constexpr double kC2 = 0.03 * 255 * 0.03 * 255;
constexpr double kDoubleTolerance = 1e-11;
/// The promised errors of float on textures, and on any images.
constexpr double kTextureTolerance = 2e-7;
constexpr double kAnyTolerance = 2e-5;

/// The smallest sizes, odd ones, and those around the width of a tile in floats and in doubles.
const std::vector<Size> kSizes = {{11, 11}, {11, 12}, {12, 11},  {13, 29},  {64, 63},
                                  {11, 74}, {15, 75}, {12, 138}, {11, 139}, {37, 271}};

/// A worn state of the same texture: less contrast, and noise.
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

/// The deficits of the first scale, as ms_ssim() computes them.
template <typename Real>
engine::MeanDeficits deficits_of(const GreyImage& a, const GreyImage& b) {
  return engine::mean_deficits<Real>(engine::centred_pair(a, b), engine::Luminance::include);
}

TEMPLATE_TEST_CASE("the deficits of an image and itself are exactly 0", "", float, double) {
  on_every_simd_target([] {
    for (const Size size : kSizes) {
      for (const auto& [name, image] : example_images(size)) {
        INFO(name);
        CHECK(deficits_of<TestType>(image, image).structure == 0.0);
        CHECK(deficits_of<TestType>(image, image).luminance == 0.0);
      }
    }
  });
}

TEMPLATE_TEST_CASE("different images have a structural deficit, however little they differ", "",
                   float, double) {
  on_every_simd_target([] {
    const GreyImage image = cloth_image({120, 150});
    GreyImage other = image;
    ++other.at(60, 60);
    CHECK(deficits_of<TestType>(image, other).structure > 0.0);
    CHECK(deficits_of<TestType>(image, other).structure < 1e-5);
  });
}

TEMPLATE_TEST_CASE("two flat images differ in luminance alone", "", float, double) {
  on_every_simd_target([] {
    for (const auto& [a, b] : {std::pair{0, 255}, {100, 101}, {7, 200}}) {
      const double l = (2.0 * a * b + kC1) / (a * a + b * b + kC1);
      const double tolerance = sizeof(TestType) == sizeof(float) ? 3e-7 : 1e-14;
      const engine::MeanDeficits deficits =
          deficits_of<TestType>(flat_image({30, 31}, a), flat_image({30, 31}, b));
      CHECK(std::abs(1.0 - deficits.luminance - l) < tolerance);
      CHECK(deficits.structure == 0.0);
    }
  });
}

TEST_CASE("the deficits of a checkerboard and its negative follow from the window") {
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
    const engine::MeanDeficits exact = deficits_of<double>(board, negative_of(board));
    CHECK(1.0 - exact.luminance == Approx(l).epsilon(1e-12));
    CHECK(1.0 - exact.structure == Approx(cs).epsilon(1e-12));
    const engine::MeanDeficits single = deficits_of<float>(board, negative_of(board));
    CHECK(std::abs(1.0 - single.luminance - l) < 1e-5);
    CHECK(std::abs(1.0 - single.structure - cs) < 1e-5);
  });
}

TEST_CASE("the deficits agree with their definition on every pair, size and target") {
  for (const Size size : kSizes) {
    for_each_pair(size, [](const GreyImage& a, const GreyImage& b) {
      const reference::Similarity expected =
          reference::similarity(converted<double>(a), converted<double>(b));
      on_every_simd_target([&] {
        const engine::MeanDeficits exact = deficits_of<double>(a, b);
        CHECK(std::abs(1.0 - exact.structure - expected.cs) < kDoubleTolerance);
        CHECK(std::abs(1.0 - exact.luminance - expected.l) < kDoubleTolerance);
        const engine::MeanDeficits single = deficits_of<float>(a, b);
        CHECK(std::abs(1.0 - single.structure - expected.cs) < kAnyTolerance);
        CHECK(std::abs(1.0 - single.luminance - expected.l) < kAnyTolerance);
      });
    });
  }
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

TEST_CASE("a negative mean counts in ms_ssim with unit exponents, and as 0 with Wang's") {
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
  CHECK_THAT(message_of<std::invalid_argument>(
                 [] { (void)engine::ms_ssim<float>(GreyImage(200, 210), GreyImage(210, 200)); }),
             names("ms_ssim 200 210"));
  CHECK_THAT(message_of<std::invalid_argument>(
                 [] { (void)engine::ms_ssim<float>(GreyImage(500, 160), GreyImage(500, 160)); }),
             names("ms_ssim 500 160 161"));
}

}  // namespace
}  // namespace touchtrial
