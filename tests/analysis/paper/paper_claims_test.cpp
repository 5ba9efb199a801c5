#include "analysis/paper/paper_claims.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <string>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

/// Measures in which every texture of a fixed order is least like the adaptive one, except at
/// `peak`.
MeasuredPicture peaking_at(double peak) {
  MeasuredPicture one;
  one.name = "made up";
  for (int k = 1; k <= engine::kSweptOrders; ++k) {
    const double order = k / 20.0;
    const double distance = std::abs(order - peak);
    one.evaluation.orders.push_back({order, order, 1.0 - distance, 1.0 - distance});
  }
  one.evaluation.adaptive.entropy = peak;
  return one;
}

void set_contrast(MeasuredPicture& one, double before, double after) {
  for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
    one.evaluation.original.glcm[i].contrast = before;
    one.evaluation.adaptive.glcm[i].contrast = after;
  }
}

const PaperClaim& claim_in(const std::vector<PaperClaim>& claims, const std::string& id) {
  const auto found = std::find_if(claims.begin(), claims.end(),
                                  [&](const PaperClaim& claim) { return claim.id == id; });
  REQUIRE(found != claims.end());
  return *found;
}

}  // namespace

TEST_CASE("the paper's own table has the changes and the contradiction that are said of it") {
  CHECK(published_roots() == Proportion{40, 38});
  CHECK(published_changes(kPaperStatistics[0]).rising == 16);
  CHECK(published_changes(kPaperStatistics[2]).falling == 16);
  CHECK(published_changes(kPaperStatistics[3]).falling == 20);
  CHECK(published_changes(kPaperStatistics[4]).total == 0);
  CHECK(published_least_correlation() == Approx(0.34025));
  for (std::size_t i = 0; i < kPublishedTable.size(); ++i) {
    INFO("picture " << i + 1);
    const TableSummary summary = summary_of(kPublishedTable[i]);
    CHECK(is_like_contradiction(summary) == (i == kPublishedContradiction));
    CHECK(summary.agrees_with_text != is_like_contradiction(summary));
    CHECK(summary.disagreement_percent < 1.0);
  }
}

TEST_CASE("contrast and correlation imply the deviation of the grey levels of all pairs") {
  RandomStream random(5, "paper claims");
  GreyImage image(40, 30);
  for (auto& level : image.samples()) level = static_cast<std::uint8_t>(random.below(200));
  double sum = 0.0;
  double squares = 0.0;
  int levels = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x + 1 < image.width(); ++x) {
      for (const int level : {image.at(y, x), image.at(y, x + 1)}) {
        sum += level;
        squares += level * level;
        ++levels;
      }
    }
  }
  const double mean = sum / levels;
  const engine::GlcmStatistics level_pairs = engine::glcm_statistics(image)[0];
  CHECK(implied_deviation(level_pairs.contrast, level_pairs.correlation) ==
        Approx(std::sqrt(squares / levels - mean * mean)));
  CHECK(implied_deviation(0.0, 1.0) == 0.0);
}

TEST_CASE("verdicts on orders follow the measures") {
  const auto verdict = [](std::vector<MeasuredPicture> pictures) {
    return verdict_of(claim_in(paper_claims({std::move(pictures), {}}), "likeness-orders"));
  };
  CHECK(verdict({peaking_at(0.65)}) == "agrees");
  CHECK(verdict({peaking_at(0.5), peaking_at(0.7)}) == "agrees");
  CHECK(verdict({peaking_at(0.45)}) == "differs");
  CHECK(verdict({peaking_at(0.75), peaking_at(0.6), peaking_at(0.9)}) == "agrees in 1 of 3");
  const auto claims = paper_claims({{peaking_at(0.3)}, {}});
  CHECK(verdict_of(claim_in(claims, "entropy-orders")) == "differs");
  CHECK_THAT(claim_in(claims, "entropy-orders").measured, names("0.30"));
}

TEST_CASE("verdicts on changes count cells, and what cannot be tested says so") {
  MeasuredPicture falling = peaking_at(0.6);
  MeasuredPicture rising = peaking_at(0.6);
  set_contrast(falling, 10.0, 5.0);
  set_contrast(rising, 10.0, 20.0);
  const auto mixed = paper_claims({{falling, rising}, {}});
  CHECK(verdict_of(claim_in(mixed, "contrast")) == "agrees in 4 of 8");
  CHECK(verdict_of(claim_in(mixed, "third-picture")) == "agrees in 1 of 2");
  CHECK(verdict_of(claim_in(paper_claims({{rising}, {}}), "contrast")) == "differs");
  CHECK(verdict_of(claim_in(mixed, "decibel")) == "cannot be tested");
  CHECK(verdict_of(claim_in(mixed, "best")) == "cannot be tested");
}
