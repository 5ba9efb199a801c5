#include "protocols/identification/analysis/report.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/report/text_table.hpp"
#include "analysis/text_matching.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <locale>
#include <sstream>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using namespace analysis::identification;

StudyReport report_of(FakeStudy& study) {
  study.close_and_unblind();
  return make_report(analysis::load_outcomes(study.store(), study.key()));
}

/// The comparison with P01 always right and P02 taking bark for straw with tv-gabor only.
StudyReport small_comparison(FakeStudy& study) {
  study.add({.participant = "P01", .enrolment = 1});
  study.add({.participant = "P02", .enrolment = 2, .answers = [](const study::Trial& shown) {
               const bool mistaken = shown.field().method == 1 && shown.field().class_index == 0;
               return mistaken ? 2 : shown.field().class_index;
             }});
  return report_of(study);
}

std::string terminal_text(const StudyReport& report, std::size_t width = analysis::kTextWidth) {
  return analysis::document_text(study_document(report, {}), width);
}

bool warned_of(const StudyReport& report, const std::string& part) {
  for (const std::string& warning : report.warnings) {
    if (contains(warning, part)) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("make_report counts each method for itself and compares two") {
  FakeStudy study(study::identification::comparison());
  const StudyReport report = small_comparison(study);
  CHECK(report.participants == 2);
  CHECK(report.trials == 48);
  REQUIRE(report.methods.size() == 2);
  CHECK(report.methods[0].overall == analysis::Proportion{24, 24});
  const MethodReport& second = report.methods[1];
  CHECK(second.overall == analysis::Proportion{24, 20});
  CHECK(second.confusion.count(0, 2) == 4);
  CHECK(second.accuracy[0].accuracy == analysis::Proportion{8, 4});
  CHECK(second.accuracy[0].wilson == analysis::wilson_interval({8, 4}));
  CHECK(second.per_participant[1].accuracy == analysis::Proportion{12, 8});
  CHECK(second.mean.mean.value() == Approx((1.0 + 2.0 / 3.0) / 2.0));
  REQUIRE(report.comparison.has_value());
  CHECK(report.comparison->difference.value() == Approx(1.0 / 6.0));
  CHECK(report.comparison->p == 1.0);
  CHECK(report.comparison->db.value() == Approx(10.0 * std::log10(6.0 / 5.0)));
}

TEST_CASE("A classification has one method and no comparison") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .answers = FakeStudy::confusing(1, 0)});
  const StudyReport report = report_of(study);
  CHECK(report.methods.size() == 1);
  CHECK_FALSE(report.comparison.has_value());
  CHECK_FALSE(nlohmann::json::parse(report_json(report)).contains("comparison"));
  CHECK(warned_of(report, "One participant"));
  CHECK(warned_of(report, "information transfer from 12 trials"));
}

TEST_CASE("A report of an open study without sessions has no numbers and says so") {
  FakeStudy study(study::identification::comparison());
  study.store().unblind(std::chrono::seconds(1), "a look", true);
  const StudyReport report = make_report(analysis::load_outcomes(study.store(), study.key()));
  CHECK(warned_of(report, "interim look"));
  CHECK(report.participants == 0);
  const auto json = nlohmann::json::parse(report_json(report));
  CHECK(json["trials"] == 0);
  CHECK(json["methods"][0]["overall"]["p"].is_null());
  CHECK(json["methods"][0]["information_transfer"]["raw"].is_null());
  CHECK(json["comparison"]["db"].is_null());
  CHECK(json["comparison"]["p"].is_null());
}

TEST_CASE("Time-outs are errors in accuracy, and their own column") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .answers = [](const study::Trial& shown) {
               return shown.place.trial <= 2 ? std::nullopt
                                             : std::optional(shown.field().class_index);
             }});
  const StudyReport report = report_of(study);
  CHECK(report.trials == 12);
  CHECK(report.methods[0].overall == analysis::Proportion{12, 10});
  CHECK(warned_of(report, "10 of 10"));
}

TEST_CASE("Sessions that are left out are reported") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1});
  study.add({.participant = "P02", .enrolment = 2, .complete = false});
  study.close_and_unblind();
  analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  CHECK(make_report(outcomes).participants == 1);
  CHECK(warned_of(make_report(outcomes), "Left out: 1 session, not completed."));
  outcomes.sessions[1].row.excluded = true;
  CHECK(warned_of(make_report(outcomes), "Left out: 1 session, excluded."));
}

TEST_CASE("report_json has the published keys in their order") {
  FakeStudy study(study::identification::comparison());
  const StudyReport report = small_comparison(study);
  const auto json = nlohmann::ordered_json::parse(report_json(report));
  const auto keys_of = [](const nlohmann::ordered_json& object) {
    std::string keys;
    for (const auto& [key, value] : object.items()) keys += key + ' ';
    return keys;
  };
  CHECK(keys_of(json) ==
        "study protocol simulated stamp simulated_on unverified_device state interim "
        "question_alone pilot participants trials classes methods comparison warnings pairs "
        "accuracy_intervals reaction_times registration collection places references registered "
        "primary "
        "prevalence looks departures public demographics said exploration ");
  CHECK(keys_of(json["methods"][1]) ==
        "method confusion no_response accuracy overall information_transfer per_participant "
        "marginals chance d_prime best_matching choice_model reaction_time_s breakdowns "
        "robustness unbiased_hits order confidence ");
  CHECK(keys_of(json["methods"][1]["accuracy"][0]) ==
        "class n correct p wilson clopper_pearson jeffreys mean interval ");
  CHECK(keys_of(json["methods"][1]["overall"]) ==
        "n correct p mean interval sd bootstrap method references spread ");
  CHECK(keys_of(json["comparison"]) == "difference interval p db ");
  CHECK(json["methods"][1]["confusion"] ==
        nlohmann::ordered_json({{4, 0, 4}, {0, 8, 0}, {0, 0, 8}}));
  CHECK(json["methods"][1]["no_response"] == nlohmann::ordered_json({0, 0, 0}));
  CHECK(json["methods"][1]["accuracy"][0]["wilson"][0] == analysis::wilson_interval({8, 4}).low);
}

TEST_CASE("A report of real participants carries no stamp") {
  FakeStudy study(study::identification::comparison(), {.simulated = false});
  const StudyReport report = small_comparison(study);
  CHECK_FALSE(contains(report_json(report), "SIMULATED"));
  CHECK_FALSE(contains(terminal_text(report), "SIMULATED"));
}

TEST_CASE("A report has decimal dots whatever the locale") {
  struct Commas : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
    [[nodiscard]] char do_thousands_sep() const override { return '.'; }
    [[nodiscard]] std::string do_grouping() const override { return "\1"; }
  };
  FakeStudy study(study::identification::comparison());
  const StudyReport report = small_comparison(study);
  const std::string json = report_json(report);
  const std::string text = terminal_text(report);
  const std::locale before = std::locale::global(std::locale(std::locale(), new Commas));
  const bool same = report_json(report) == json && terminal_text(report) == text;
  std::locale::global(before);
  CHECK(same);
}

TEST_CASE("Every table of a simulated report is stamped and fits the terminal") {
  FakeStudy study(study::identification::comparison(),
                  {.label = "an uncommonly long label for one texture"});
  const StudyReport report = small_comparison(study);
  for (const std::size_t width : {std::size_t{80}, analysis::kTextWidth}) {
    std::istringstream text(terminal_text(report, width));
    bool after_gap = false;
    std::string line;
    std::string last;
    std::getline(text, line);
    CHECK(line.starts_with("simulated on: "));
    std::getline(text, line);
    CHECK(line.starts_with("SIMULATED"));
    while (std::getline(text, line)) {
      CHECK(analysis::display_width(line) <= width);
      if (after_gap) CHECK(contains(line, "SIMULATED"));
      after_gap = line.empty();
      last = line;
    }
    CHECK(last.starts_with("SIMULATED"));
  }
}

TEST_CASE(
    "The report of a comparison has its sections on the terminal, and a table of each result") {
  FakeStudy study(study::identification::comparison());
  const StudyReport report = small_comparison(study);
  std::string titles;
  std::istringstream text(terminal_text(report));
  for (std::string line, before; std::getline(text, line); before = line) {
    if (line.starts_with("---")) titles += before.substr(0, before.find(" [")) + "; ";
  }
  CHECK(titles ==
        "Result; Comparison of methods; Accuracy; Confusions; Participants; This report; ");
  std::string ids;
  std::string headline;
  const analysis::Document document = study_document(report, {});
  for (const analysis::Table* table : analysis::tables_of(document)) {
    ids += table->id + ' ';
    if (table->id != "headline") continue;
    for (const analysis::Cell& cell : table->rows.at(1)) headline += cell.text + " | ";
  }
  CHECK(headline.starts_with("tv-gabor | 2 | 24 | 83.3% | [0.0, 100.0] | 21.9 [0.0, 37.3] | "));
  CHECK(ids ==
        "primary methods methods-by-class-1 headline accuracy-by-class-adaptive "
        "accuracy-by-class-tv-gabor ability accuracy-by-participant confusions-adaptive "
        "confusions-tv-gabor answers-by-place order-adaptive accuracy-by-order-group-adaptive "
        "order-tv-gabor accuracy-by-order-group-tv-gabor with-and-without-adaptive "
        "with-and-without-tv-gabor explorations looks ");
}

}  // namespace touchtrial
