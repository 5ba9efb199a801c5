#include "analysis/measures/picture_set.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::engine;

namespace {

/// Blocks of random greys around 128; `contrast` is their largest distance from it.
GreyImage blocks(std::uint64_t seed, int side, int contrast) {
  RandomStream random(seed, "picture set test");
  Plane<int> greys(side / 4 + 1, side / 4 + 1);
  for (int& grey : greys.samples()) {
    grey = 128 - contrast + static_cast<int>(random.below(2 * contrast + 1));
  }
  GreyImage image(side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      image.at(y, x) = static_cast<std::uint8_t>(greys.at(y / 4, x / 4));
    }
  }
  return image;
}

MeasuredPictures measured(const std::vector<LabelledPicture>& pictures,
                          const RenderingOptions& rendering = {}) {
  return measure_pictures(pictures, {}, rendering);
}

}  // namespace

TEST_CASE("a picture's measures are those of its greys, texture and force") {
  const auto result = measured({{"s", "flat", "flat.png", GreyImage(64, 64, 90)},
                                {"s", "weak", "weak.png", blocks(1, 64, 20)},
                                {"s", "strong", "strong.png", blocks(1, 64, 80)}});
  REQUIRE(result.pictures.size() == 3);
  const PictureMeasures& flat = result.pictures[0];
  CHECK(flat.mean == Approx(90.0));
  CHECK(flat.deviation == Approx(0.0).margin(1e-9));
  CHECK(flat.slope == 0.0);
  CHECK(flat.original.angular_second_moment == Approx(1.0));
  CHECK(flat.force_rms_n == 0.0);
  CHECK(result.pictures[2].force_rms_n > 2.0 * result.pictures[1].force_rms_n);
  CHECK(result.pictures[1].texture.contrast < result.pictures[2].texture.contrast);
  CHECK(result.tangential_gain_n > 0.0);
  for (const PictureMeasures& picture : result.pictures) {
    CHECK(picture.renderable_share >= 0.0);
    CHECK(picture.renderable_share <= 1.0);
  }
}

TEST_CASE("small pictures have no similarity") {
  const auto result = measured({{"s", "weak", "a", blocks(1, 80, 10)},
                                {"s", "weak", "b", blocks(2, 80, 10)},
                                {"s", "strong", "c", blocks(3, 80, 90)},
                                {"s", "strong", "d", blocks(4, 80, 90)}});
  REQUIRE(result.sets.size() == 1);
  const SetMeasures& set = result.sets[0];
  CHECK(set.classes == 2);
  CHECK(set.pictures == 4);
  CHECK_FALSE(set.similarity.has_value());
}

TEST_CASE("similarity tells pictures of one class from pictures of two") {
  const GreyImage one = blocks(1, 168, 60);
  const GreyImage other = blocks(2, 176, 60);
  int last = 0;
  const MeasuredPictures result =
      measure_pictures(std::vector<LabelledPicture>{{"s", "one", "a", one},
                                                    {"s", "one", "b", one},
                                                    {"s", "two", "c", other},
                                                    {"t", "x", "d", one}},
                       {}, {}, [&](int done, int of) {
                         CHECK(of == 3);
                         last = done;
                       });
  CHECK(last == 3);
  REQUIRE(result.sets.size() == 2);
  REQUIRE(result.sets[0].similarity.has_value());
  const Similarity& similarity = *result.sets[0].similarity;
  CHECK(similarity.original_within.pairs == 1);
  CHECK(similarity.original_within.mean == Approx(1.0));
  CHECK(similarity.texture_within.mean == Approx(1.0));
  CHECK(similarity.original_between.pairs == 2);
  CHECK(std::abs(similarity.original_between.mean) < 0.1);
}

TEST_CASE("equalising is ignored, and an empty set is refused") {
  RenderingOptions equalised{.equalise = Equalise::rms};
  const std::vector<LabelledPicture> pictures = {{"s", "weak", "a", blocks(1, 64, 10)},
                                                 {"s", "strong", "b", blocks(2, 64, 90)}};
  CHECK(measured(pictures, equalised).pictures[0].force_rms_n ==
        measured(pictures).pictures[0].force_rms_n);
  CHECK_THROWS_AS(measured({}), std::invalid_argument);
  CHECK_THROWS_AS(measured({{"s", "a", "a", GreyImage(20, 20, 1)}}), std::invalid_argument);
}

TEST_CASE("measures are printed as tables and as JSON") {
  const auto result = measured({{"set one", "weak", "in/a.png", blocks(1, 64, 10)},
                                {"set one", "strong", "in/b.png", blocks(2, 64, 90)}});
  const std::string text = measures_text(result);
  CHECK_THAT(text, holds_text("a.png"));
  CHECK_THAT(text, holds_text("set one"));
  const auto json = nlohmann::json::parse(measures_json(result));
  CHECK(json.at("pictures").size() == 2);
  CHECK(json.at("pictures")[1].at("picture") == "in/b.png");
  CHECK(json.at("pictures")[1].at("force_rms_n") == result.pictures[1].force_rms_n);
  CHECK(json.at("sets")[0].at("ms_ssim").is_null());
}
