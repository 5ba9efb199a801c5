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
  study.add({.participant = "P02", .enrolment = 2, .complete = false, .stop_after = 2});
  study.close_and_unblind();
}

std::string script_of(const analysis::Outcomes& outcomes) {
  return analysis::r_script_of(analysis::identification::mixed_model(outcomes), outcomes);
}

}  // namespace

TEST_CASE("The table for a mixed model has the trials of the report and what came before them") {
  FakeStudy study(study::identification::comparison(), {.trials = R"({"lead_in": 1})"});
  fill(study);
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const analysis::identification::StudyReport report =
      analysis::identification::make_report(outcomes);
  analysis::export_r_model(study.store(), outcomes, study.folder() / "r");
  const std::vector<CsvRow> rows = rows_of(study.folder() / "r" / "mixed_model.csv");
  REQUIRE(static_cast<int>(rows.size()) == report.trials);
  int correct = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    check_row(rows[i], "participant=P01, simulated=1");
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

TEST_CASE("In the mixed model people differ in what is compared, and few images are fixed") {
  FakeStudy pair(study::identification::comparison());
  fill(pair);
  analysis::Outcomes two = analysis::load_outcomes(pair.store(), pair.key());
  CHECK(analysis::identification::mixed_model_formula(two) ==
        "correct ~ method * image + period + (1 + method | participant)");
  CHECK(contains(script_of(two), "methods <- c(\"adaptive\", \"tv-gabor\")"));
  two.exemplars = {{"1", "2", "3", "4", "5"}, {"6", "7", "8", "9", "10"}};
  CHECK(analysis::identification::mixed_model_formula(two) ==
        "correct ~ method + period + (1 + method | participant) + (1 + method | image)");
  FakeStudy single(study::identification::classification());
  fill(single);
  const analysis::Outcomes one = analysis::load_outcomes(single.store(), single.key());
  CHECK(analysis::identification::mixed_model_formula(one) ==
        "correct ~ image + (1 | participant)");
  CHECK(contains(script_of(one), "SIMULATED"));
}

TEST_CASE("The script of the mixed model holds all of its functions, and says what it leaves out") {
  FakeStudy study(study::identification::comparison());
  fill(study);
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const std::string script = script_of(outcomes);
  CHECK(script.ends_with(analysis::identification::mixed_model_functions()));
  CHECK(script.ends_with("if (sys.nframe() == 0L) main(methods)\n"));
  // No fallback leaves people differing in their accuracy alone.
  CHECK_FALSE(contains(script, "(1 | participant)"));
  analysis::export_r_model(study.store(), outcomes, study.folder() / "r");
  const std::string notes = text_of_file(study.folder() / "r" / "mixed_model.md");
  CHECK(contains(notes, "(1 + method | participant)"));
}

}  // namespace touchtrial
