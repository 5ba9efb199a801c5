#include "analysis/paper/paper_document.hpp"
#include "support/catch.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

constexpr int kSide_px = 162;  ///< even, and enough for MS-SSIM

PaperPicture chequered(int period) {
  GreyImage image(kSide_px, kSide_px);
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      image.at(y, x) = static_cast<std::uint8_t>((x / period + y / period) % 2 == 0 ? 60 : 180);
    }
  }
  return {"period " + std::to_string(period), image};
}

}  // namespace

TEST_CASE("fine textures have their power in the finest sub-bands, coarse ones less") {
  const std::vector<PaperPicture> pictures = {chequered(1), chequered(8)};
  const PaperMeasures measures = measure_for_paper(pictures, {});
  CHECK(measures.pictures[0].adaptive.fine_share > 0.95);
  CHECK(measures.pictures[1].adaptive.fine_share < 0.8);
  CHECK(measures.pictures[0].fixed[0].rms_grey < measures.pictures[0].fixed[2].rms_grey);
  for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
    CHECK(measures.pictures[1].readings[0][i].contrast ==
          measures.pictures[1].evaluation.adaptive.glcm[i].contrast);
  }
}

TEST_CASE("a flat picture has measures, and its page and numbers are finite") {
  const std::vector<PaperPicture> flat = {{"flat", GreyImage(161, 161, 128)}};
  int last = 0;
  const PaperMeasures measures =
      measure_for_paper(flat, flat, [&](int done, int of) { last = of - done; });
  CHECK(last == 0);
  CHECK(measures.pictures[0].adaptive.rms_grey == 0.0);
  CHECK(measures.pictures[0].adaptive.fine_share == 0.0);
  CHECK(measures.compared[0].ms_ssim == 1.0);
  const PaperPictures pictures = paper_pictures(flat, flat);
  const std::string page = document_markdown(
      paper_document(measures, pictures, {"paper-sweep", "c", "a", ""}, "it"), "images");
  CHECK(page.find("nan") == std::string::npos);
  CHECK(page.find("inf ") == std::string::npos);
  CHECK_FALSE(nlohmann::json::parse(paper_json(measures))["claims"].empty());
}

TEST_CASE("pictures too small for MS-SSIM are refused") {
  const std::vector<PaperPicture> small = {{"small", GreyImage(160, 200, 3)}};
  CHECK_THROWS_AS(measure_for_paper(small, {}), std::invalid_argument);
}
