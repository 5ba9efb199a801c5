#include "engine/evaluation.hpp"

#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/metrics/picture_statistics.hpp"
#include "engine/metrics/ssim.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <cstddef>

#include <tbb/task_arena.h>

namespace touchtrial {
namespace {

GreyImage fixed_picture(const GreyImage& image, double order) {
  engine::ExtractionOptions options{.method = engine::Method::fixed, .order = order};
  return engine::texture_picture(engine::extract_texture<double>(image, options).texture);
}

TEST_CASE("an evaluation measures the image and its adaptive texture") {
  const GreyImage image = cloth_image({20, 31});
  const engine::Evaluation evaluation = engine::evaluate_image(image, false);
  const GreyImage texture =
      engine::texture_picture(engine::extract_texture<double>(image, {}).texture);
  CHECK(evaluation.height == 20);
  CHECK(evaluation.width == 31);
  CHECK(evaluation.original.entropy == engine::entropy(image));
  CHECK(evaluation.adaptive.entropy == engine::entropy(texture));
  const engine::GlcmTable original = engine::glcm_statistics(image);
  const engine::GlcmTable adaptive = engine::glcm_statistics(texture);
  for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
    CHECK(evaluation.original.glcm[i].contrast == original[i].contrast);
    CHECK(evaluation.adaptive.glcm[i].contrast == adaptive[i].contrast);
  }
  CHECK(evaluation.orders.empty());
}

TEST_CASE("a megapixel is evaluated by several threads at once, to the same digits as by one") {
  const GreyImage image = cloth_image({1003, 1009});
  const engine::Evaluation all = engine::evaluate_image(image, true);
  engine::Evaluation alone;
  tbb::task_arena one(1);
  one.execute([&] { alone = engine::evaluate_image(image, true); });
  CHECK(all.original.entropy == alone.original.entropy);
  for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
    CHECK(all.original.glcm[i].correlation == alone.original.glcm[i].correlation);
    CHECK(all.adaptive.glcm[i].entropy == alone.adaptive.glcm[i].entropy);
  }
  REQUIRE(all.orders.size() == alone.orders.size());
  for (std::size_t i = 0; i < all.orders.size(); ++i) {
    CHECK(all.orders[i].order == alone.orders[i].order);
    CHECK(all.orders[i].ms_ssim == alone.orders[i].ms_ssim);
    CHECK(all.orders[i].entropy == alone.orders[i].entropy);
  }
}

TEST_CASE("a sweep compares the adaptive texture with every fixed order") {
  const GreyImage image = cloth_image({170, 163});
  int calls = 0;
  const engine::Evaluation evaluation = engine::evaluate_image(image, true, [&] { ++calls; });
  CHECK(calls == engine::kSweptOrders);
  REQUIRE(evaluation.orders.size() == engine::kSweptOrders);
  CHECK(evaluation.orders.front().order == 0.05);
  CHECK(evaluation.orders[2].order == 0.15);
  CHECK(evaluation.orders.back().order == 0.95);
  const GreyImage adaptive =
      engine::texture_picture(engine::extract_texture<double>(image, {}).texture);
  for (const std::size_t i : {std::size_t{0}, std::size_t{12}}) {
    const engine::OrderEvaluation& figures = evaluation.orders[i];
    const GreyImage fixed = fixed_picture(image, figures.order);
    CHECK(figures.entropy == engine::entropy(fixed));
    CHECK(figures.ms_ssim == engine::ms_ssim<double>(adaptive, fixed).unit);
    CHECK(figures.ms_ssim_wang == engine::ms_ssim<double>(adaptive, fixed).wang);
  }
  for (const engine::OrderEvaluation& figures : evaluation.orders) {
    CHECK(engine::closest_order(evaluation).ms_ssim >= figures.ms_ssim);
  }
}

TEST_CASE("for a flat image every fixed order gives the adaptive texture") {
  const engine::Evaluation evaluation = engine::evaluate_image(flat_image({161, 161}, 77), true);
  for (const engine::OrderEvaluation& figures : evaluation.orders) {
    CHECK(figures.ms_ssim == 1.0);
    CHECK(figures.entropy == 0.0);
  }
  CHECK(engine::closest_order(evaluation).order == 0.05);
}

TEST_CASE("an image that is too small is refused with its size and the least size") {
  CHECK_THAT(message_of<std::invalid_argument>([] {
               (void)engine::evaluate_image(noise_image({160, 500}), true);
             }),
             names("500 160 161"));
  CHECK(message_of<std::invalid_argument>([] {
          (void)engine::evaluate_image(noise_image({160, 500}), false);
        }).empty());
  CHECK_THAT(message_of<std::invalid_argument>([] {
               (void)engine::evaluate_image(noise_image({1, 9}), false);
             }),
             names("9 1 2"));
}

}  // namespace
}  // namespace touchtrial
