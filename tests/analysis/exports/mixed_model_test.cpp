#include "protocols/identification/analysis/mixed_model.hpp"

#include "analysis/exports/csv_reading.hpp"
#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

void fill(FakeStudy& study) {
  study.add({.participant = "P01",
             .enrolment = 1,
             .answers = FakeStudy::confusing(0, 1),
             .interrupt_trial = 3});
  study.add({.participant = "P02",
             .enrolment = 2,
             .answers = FakeStudy::always_right(),
             .complete = false,
             .stop_after = 2});
  study.close_and_unblind();
}

}  // namespace

TEST_CASE("The table for a mixed model has the trials of the report and what came before them") {
  FakeStudy study(design::identification::comparison(), {.trials = R"({"lead_in": 1})"});
  fill(study);
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const analysis::identification::StudyReport report =
      analysis::identification::make_report(outcomes);
  analysis::identification::export_mixed_model(study.store(), outcomes, study.folder() / "r");
  const std::vector<CsvRow> rows = rows_of(study.folder() / "r" / "mixed_model.csv");
  REQUIRE(static_cast<int>(rows.size()) == report.trials);
  int correct = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(rows[i].at("participant") == "P01");
    CHECK(rows[i].at("simulated") == "1");
    CHECK(rows[i].at("image").starts_with(rows[i].at("class") + ": "));
    correct += rows[i].at("correct") == "1" ? 1 : 0;
    // The interrupted trial was repeated at the end, after another block.
    CHECK(rows[i].at("previous_class").empty() == (rows[i].at("trial") == "3"));
    if (i == 0 || rows[i].at("block") != rows[i - 1].at("block")) continue;
    CHECK(rows[i].at("previous_class") == rows[i - 1].at("class"));
    CHECK(rows[i].at("previous_response") == rows[i - 1].at("response"));
  }
  CHECK(correct == report.methods[0].overall.correct + report.methods[1].overall.correct);
}

TEST_CASE("The mixed model compares methods, or asks for the level of one") {
  FakeStudy pair(design::identification::comparison());
  fill(pair);
  const analysis::Outcomes two = analysis::load_outcomes(pair.store(), pair.key());
  CHECK(analysis::identification::mixed_model_formula(two) ==
        "correct ~ method + (1 | participant) + (1 | image)");
  CHECK(contains(analysis::identification::mixed_model_script(two),
                 "methods <- c(\"adaptive\", \"tv-gabor\")"));
  FakeStudy single(design::identification::classification());
  fill(single);
  const analysis::Outcomes one = analysis::load_outcomes(single.store(), single.key());
  CHECK(analysis::identification::mixed_model_formula(one) ==
        "correct ~ 1 + (1 | participant) + (1 | image)");
  CHECK(contains(analysis::identification::mixed_model_script(one), "SIMULATED"));
}

}  // namespace touchtrial
