#include "analysis/checkers/whole_page.hpp"
#include "analysis/report/figures/figure.hpp"
#include "protocols/rating/analysis/figures.hpp"
#include "protocols/rating/analysis/hand_made_ratings.hpp"
#include "protocols/rating/analysis/page.hpp"
#include "protocols/rating/analysis/rating_analysis.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

namespace own = analysis::rating;

/// Seven people who rate the first method higher, with catch trials.
HandMadeRatings seven_people(const std::string& section, const std::vector<std::string>& methods) {
  HandMadeRatings made(section, methods);
  for (int p = 1; p <= 7; ++p) {
    made.session();
    for (int i = 0; i < 4; ++i) {
      for (int m = 0; m < static_cast<int>(methods.size()); ++m) {
        const int step = (p * (i + 1) + m) % 3;
        std::vector<double> values{0.7 - 0.2 * m + 0.05 * step};
        if (section == kTwoScales) values.push_back(5.0 - m + step);
        made.rated(p, i % 2, m, values);
      }
    }
    made.caught(p, section == kTwoScales ? std::vector{0.1, 2.0} : std::vector{0.1});
  }
  return made;
}

std::vector<HandMadeRatings> kinds_of_rated_studies() {
  return {seven_people(kOneScale, {"adaptive", "fixed"}),
          seven_people(kTwoScales, {"adaptive", "fixed", "tv-gabor"}),
          seven_people(kOneScale, {"adaptive"})};
}

}  // namespace

TEST_CASE("every page of ratings is whole, with figures described in words") {
  for (HandMadeRatings& made : kinds_of_rated_studies()) {
    made.outcomes.simulated = true;
    check_whole_page(*own::rating_analysis().results(made.outcomes, {}));
  }
}

TEST_CASE("a page of ratings begins with the difference of the first two methods") {
  const HandMadeRatings made = seven_people(kOneScale, {"adaptive", "fixed"});
  const analysis::Document document =
      own::rating_analysis().results(made.outcomes, {})->document({}, {});
  REQUIRE(document.sections.front().id == "result");
  const std::string said = said_in(document);
  CHECK_THAT(said, names("adaptive fixed 7 0.016") && holds_text(": +0."));
  std::vector<std::string> ids;
  for (const analysis::Table* table : analysis::tables_of(document)) ids.push_back(table->id);
  for (const char* id : {"means", "means-over-items", "differences-of-methods", "reliability",
                         "use-of-the-scale", "catch-trials"}) {
    INFO(id);
    CHECK(std::ranges::count(ids, id) == 1);
  }
  CHECK_THAT(analysis::tables_latex(document), holds_text("bark"));
  CHECK_THAT(analysis::document_markdown(analysis::tables_only(document), ""),
             holds_text("| bark"));
}

TEST_CASE("with several scales every table says which one it is of") {
  const HandMadeRatings made = seven_people(kTwoScales, {"adaptive", "fixed", "tv-gabor"});
  const analysis::Document document =
      own::rating_analysis().results(made.outcomes, {})->document({}, {});
  std::vector<std::string> ids;
  for (const analysis::Table* table : analysis::tables_of(document)) {
    ids.push_back(table->id);
    if (table->id.starts_with("means")) CHECK_THAT(table->caption, holds_text("(scale "));
  }
  std::ranges::sort(ids);
  CHECK(std::ranges::adjacent_find(ids) == ids.end());
  CHECK(std::ranges::count(ids, "means-2") == 1);
  CHECK_THAT(said_in(document), names("3"));
}

TEST_CASE("one method has its mean at the top and no differences") {
  const HandMadeRatings made = seven_people(kOneScale, {"adaptive"});
  const analysis::Document document =
      own::rating_analysis().results(made.outcomes, {})->document({}, {});
  CHECK_THAT(said_in(document), holds_text("adaptive: 0.7"));
  CHECK(std::ranges::none_of(document.sections, [](const analysis::Section& section) {
    return section.id == "differences";
  }));
}

TEST_CASE("gnuplot draws every figure of ratings") {
  for (const HandMadeRatings& made : kinds_of_rated_studies()) {
    const own::RatingReport report = own::make_report(made.outcomes);
    const std::vector<analysis::Figure> figures = own::report_figures(report, {}, "");
    CHECK(std::ranges::count_if(figures, [](const analysis::Figure& figure) {
            return figure.id.starts_with("ratings");
          }) == static_cast<std::ptrdiff_t>(report.scales.size()));
    for (const std::string& svg : analysis::draw_figures(figures, analysis::FigureFormat::svg)) {
      CHECK(svg.size() > 1000);
    }
  }
}

}  // namespace touchtrial
