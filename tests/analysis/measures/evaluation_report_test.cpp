#include "analysis/measures/evaluation_report.hpp"

#include "support/catch.hpp"
#include "support/names.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::engine;
using nlohmann::json;

namespace {

EvaluatedImage example(bool swept) {
  EvaluatedImage image{"folder/it's.png", {}};
  Evaluation& evaluation = image.evaluation;
  evaluation.height = 200;
  evaluation.width = 300;
  evaluation.original = {5.25, {}};
  evaluation.adaptive = {4.125, {}};
  evaluation.original.glcm[1] = {0.0004, 0.02, 9.5, 782.97, 0.602};
  if (swept) evaluation.orders = {{0.05, 2.0, 0.25, 0.75}, {0.1, 3.0, 0.995, 0.999}};
  return image;
}

}  // namespace

TEST_CASE("the evaluation's JSON has its documented shape") {
  const std::vector<EvaluatedImage> images = {example(true), example(false)};
  const json object = json::parse(evaluation_json(images));
  CHECK(object.size() == 1);
  REQUIRE(object["images"].size() == 2);
  const json& first = object["images"][0];
  CHECK(first["image"] == "folder/it's.png");
  CHECK(first["original"]["entropy"] == 5.25);
  CHECK(first["adaptive"]["entropy"] == 4.125);
  for (const char* direction : {"0", "45", "90", "135"}) {
    CHECK(first["adaptive"]["glcm"][direction].size() == 5);
  }
  CHECK(first["original"]["glcm"]["45"] == json{{"asm", 0.0004},
                                                {"energy", 0.02},
                                                {"entropy", 9.5},
                                                {"contrast", 782.97},
                                                {"correlation", 0.602}});
  REQUIRE(first["orders"].size() == 2);
  CHECK(first["orders"][1] ==
        json{{"order", 0.1}, {"entropy", 3.0}, {"ms_ssim", 0.995}, {"ms_ssim_wang", 0.999}});
  CHECK_FALSE(object["images"][1].contains("orders"));
}

TEST_CASE("the evaluation's text names the paper's entropy and the closest fixed order") {
  const std::vector<EvaluatedImage> swept = {example(true)};
  const std::string text = evaluation_text(swept);
  CHECK_THAT(text, names("300 200"));
  CHECK_THAT(text, holds_text("Table 1"));
  CHECK_THAT(text, names("0.10 0.99500 0.99900"));
  CHECK_THAT(text, holds_text("782.97"));
  const std::vector<EvaluatedImage> unswept = {example(false)};
  CHECK(evaluation_text(unswept).find("fixed order") == std::string::npos);
}
