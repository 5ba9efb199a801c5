#include "protocols/identification/analysis/report.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "analysis/text_table.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <locale>
#include <sstream>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

/// The comparison with P01 always right and P02 taking bark for straw with tv-gabor only.
analysis::identification::StudyReport small_comparison(FakeStudy& study) {
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::always_right()});
  study.add(
      {.participant = "P02", .enrolment = 2, .answers = [](const design::Presentation& shown) {
         const bool mistaken = shown.stimulus.method == 1 && shown.stimulus.class_index == 0;
         return mistaken ? 2 : shown.stimulus.class_index;
       }});
  study.close_and_unblind();
  return analysis::identification::make_report(analysis::load_outcomes(study.store(), study.key()));
}

bool warned_of(const analysis::identification::StudyReport& report, const std::string& part) {
  for (const std::string& warning : report.warnings) {
    if (contains(warning, part)) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("make_report counts each method for itself and compares two") {
  FakeStudy study(design::identification::comparison());
  const analysis::identification::StudyReport report = small_comparison(study);
  CHECK(report.participants == 2);
  CHECK(report.trials == 48);
  REQUIRE(report.methods.size() == 2);
  CHECK(report.methods[0].overall == analysis::Proportion{24, 24});
  const analysis::identification::MethodReport& second = report.methods[1];
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
  FakeStudy study(design::identification::classification());
  study.add({.participant = "P01", .answers = FakeStudy::confusing(1, 0)});
  study.close_and_unblind();
  const analysis::identification::StudyReport report =
      analysis::identification::make_report(analysis::load_outcomes(study.store(), study.key()));
  CHECK(report.methods.size() == 1);
  CHECK_FALSE(report.comparison.has_value());
  CHECK_FALSE(
      nlohmann::json::parse(analysis::identification::report_json(report)).contains("comparison"));
  CHECK(warned_of(report, "One participant"));
  CHECK(warned_of(report, "information transfer from 12 trials"));
}

TEST_CASE("A report of an open study without sessions has no figures and says so") {
  FakeStudy study(design::identification::comparison());
  study.store().unblind(std::chrono::seconds(1), "a look", true);
  const analysis::identification::StudyReport report =
      analysis::identification::make_report(analysis::load_outcomes(study.store(), study.key()));
  CHECK(warned_of(report, "interim look"));
  CHECK(warned_of(report, "nothing to report"));
  const auto json = nlohmann::json::parse(analysis::identification::report_json(report));
  CHECK(json["trials"] == 0);
  CHECK(json["methods"][0]["overall"]["p"].is_null());
  CHECK(json["methods"][0]["information_transfer"]["raw"].is_null());
  CHECK(json["comparison"]["db"].is_null());
  CHECK(json["comparison"]["p"].is_null());
}

TEST_CASE("Time-outs are errors in accuracy, and their own column") {
  FakeStudy study(design::identification::classification());
  study.add({.participant = "P01", .answers = [](const design::Presentation& shown) {
               return shown.trial <= 2 ? std::nullopt : std::optional(shown.stimulus.class_index);
             }});
  study.close_and_unblind();
  const analysis::identification::StudyReport report =
      analysis::identification::make_report(analysis::load_outcomes(study.store(), study.key()));
  CHECK(report.trials == 12);
  CHECK(report.methods[0].overall == analysis::Proportion{12, 10});
  CHECK(warned_of(report,
                  "2 trials without a response, counted as wrong; with them excluded 10 of 10"));
}

TEST_CASE("Sessions that are left out are told") {
  FakeStudy study(design::identification::classification());
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::always_right()});
  study.add({.participant = "P02",
             .enrolment = 2,
             .answers = FakeStudy::always_right(),
             .complete = false});
  study.close_and_unblind();
  analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  CHECK(analysis::identification::make_report(outcomes).participants == 1);
  CHECK(warned_of(analysis::identification::make_report(outcomes),
                  "Left out: 1 session, not completed."));
  outcomes.sessions[1].row.excluded = true;
  CHECK(
      warned_of(analysis::identification::make_report(outcomes), "Left out: 1 session, excluded."));
}

TEST_CASE("report_json has the published keys in their order") {
  FakeStudy study(design::identification::comparison());
  const analysis::identification::StudyReport report = small_comparison(study);
  const auto json = nlohmann::ordered_json::parse(analysis::identification::report_json(report));
  const auto keys_of = [](const nlohmann::ordered_json& object) {
    std::string keys;
    for (const auto& [key, value] : object.items()) keys += key + ' ';
    return keys;
  };
  CHECK(keys_of(json) ==
        "study protocol simulated stamp state interim pilot participants trials classes methods "
        "comparison warnings "
        "pairs "
        "accuracy_intervals reaction_times registration collection references ");
  CHECK(keys_of(json["methods"][1]) ==
        "method confusion no_response accuracy overall information_transfer per_participant "
        "marginals chance d_prime best_matching choice_model reaction_time_s breakdowns "
        "robustness ");
  CHECK(keys_of(json["methods"][1]["accuracy"][0]) ==
        "class n correct p wilson clopper_pearson jeffreys ");
  CHECK(keys_of(json["methods"][1]["overall"]) ==
        "n correct p mean interval sd bootstrap method references ");
  CHECK(keys_of(json["comparison"]) == "difference interval p db ");
  CHECK(json["methods"][1]["confusion"] ==
        nlohmann::ordered_json({{4, 0, 4}, {0, 8, 0}, {0, 0, 8}}));
  CHECK(json["methods"][1]["no_response"] == nlohmann::ordered_json({0, 0, 0}));
  CHECK(json["methods"][1]["accuracy"][0]["wilson"][0] == analysis::wilson_interval({8, 4}).low);
}

TEST_CASE("A report of real participants carries no stamp") {
  FakeStudy study(design::identification::comparison(), {.simulated = false});
  const analysis::identification::StudyReport report = small_comparison(study);
  CHECK_FALSE(contains(analysis::identification::report_json(report), "SIMULATED"));
  CHECK_FALSE(contains(analysis::identification::report_text(report), "SIMULATED"));
}

TEST_CASE("A report has decimal dots whatever the locale") {
  struct Commas : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
    [[nodiscard]] char do_thousands_sep() const override { return '.'; }
    [[nodiscard]] std::string do_grouping() const override { return "\1"; }
  };
  FakeStudy study(design::identification::comparison());
  const analysis::identification::StudyReport report = small_comparison(study);
  const std::string json = analysis::identification::report_json(report);
  const std::string text = analysis::identification::report_text(report);
  const std::locale before = std::locale::global(std::locale(std::locale(), new Commas));
  const bool same = analysis::identification::report_json(report) == json &&
                    analysis::identification::report_text(report) == text;
  std::locale::global(before);
  CHECK(same);
}

TEST_CASE("Every table of a simulated report is stamped and fits the terminal") {
  FakeStudy study(design::identification::comparison(),
                  {.label = "an uncommonly long label for one texture"});
  std::istringstream text(analysis::identification::report_text(small_comparison(study)));
  bool after_gap = false;
  std::string line;
  std::string last;
  std::getline(text, line);
  CHECK(line.starts_with("SIMULATED"));
  while (std::getline(text, line)) {
    CHECK(analysis::display_width(line) <= analysis::kTextWidth);
    if (after_gap) CHECK(contains(line, "SIMULATED"));
    after_gap = line.empty();
    last = line;
  }
  CHECK(last.starts_with("SIMULATED"));
}

TEST_CASE("report_text keeps its layout") {
  FakeStudy study(design::identification::comparison());
  study.add(
      {.participant = "P01", .enrolment = 1, .answers = [](const design::Presentation& shown) {
         const bool mistaken = shown.stimulus.method == 1 && shown.stimulus.class_index == 0;
         return mistaken ? 2 : shown.stimulus.class_index;
       }});
  study.add(
      {.participant = "Ann+1", .enrolment = 2, .answers = [](const design::Presentation& shown) {
         return shown.trial == 24 ? std::nullopt : std::optional(shown.stimulus.class_index);
       }});
  study.close_and_unblind();
  const std::string text = analysis::identification::report_text(
      analysis::identification::make_report(analysis::load_outcomes(study.store(), study.key())));
  CHECK(text == R"(SIMULATED: these figures come from simulated participants.
pair (comparison): 2 participants, 48 trials; chance is 33.3%
2 enrolled, 2 analysed

adaptive: confusions (rows: presented, columns: answered; count and row %) [SIMULATED]
  presented      bark     cloth     straw  no response   n
  bark       8 (100%)         .         .            .   8
  cloth             .  8 (100%)         .            .   8
  straw             .         .  8 (100%)            .   8
  all               8         8         8            0  24

adaptive: accuracy of each class [SIMULATED]
  class  n  correct  accuracy    Wilson 95 %  Clopper-Pearson 95 %
  bark   8        8    100.0%  [67.6, 100.0]         [63.1, 100.0]
  cloth  8        8    100.0%  [67.6, 100.0]         [63.1, 100.0]
  straw  8        8    100.0%  [67.6, 100.0]         [63.1, 100.0]

adaptive: accuracy of each participant [SIMULATED]
  P01     12/12 100.0%   Ann+1   12/12 100.0%

adaptive: overall [SIMULATED]
  mean over 2 participants 100.0%, 95 % interval [100.0, 100.0], bootstrap [100.0, 100.0]
  pooled 24 of 24, 100.0%; by chance 8.0, p = 8.33e-10 (exact)
  100.0% under the best exchange of labels
  information transfer 1.58 bit raw, 1.46 corrected, 0.14 if answers were dealt at random
  answered after 4.25 s [4.25, 4.25] (median, quartiles), 3.75 s [3.75, 3.75] from contact

tv-gabor: confusions (rows: presented, columns: answered; count and row %) [SIMULATED]
  presented      bark     cloth     straw  no response   n
  bark       4  (50%)         .  4  (50%)            .   8
  cloth             .  7  (88%)         .     1  (12%)   8
  straw             .         .  8 (100%)            .   8
  all               4         7        12            1  24

tv-gabor: accuracy of each class [SIMULATED]
  class  n  correct  accuracy    Wilson 95 %  Clopper-Pearson 95 %
  bark   8        4     50.0%   [21.5, 78.5]          [15.7, 84.3]
  cloth  8        7     87.5%   [52.9, 97.8]          [47.3, 99.7]
  straw  8        8    100.0%  [67.6, 100.0]         [63.1, 100.0]

tv-gabor: accuracy of each participant [SIMULATED]
  P01      8/12  66.7%   Ann+1   11/12  91.7%

tv-gabor: overall [SIMULATED]
  mean over 2 participants 79.2%, 95 % interval [0.0, 100.0], bootstrap [66.7, 91.7]
  pooled 19 of 24, 79.2%; by chance 7.7, p = 5.83e-08 (exact)
  79.2% under the best exchange of labels
  information transfer 1.10 bit raw, 0.98 corrected, 0.14 if answers were dealt at random
  answered after 4.25 s [4.25, 4.25] (median, quartiles), 3.75 s [3.75, 3.75] from contact
  the mean with other trials: answered trials alone 83.3%

adaptive beside tv-gabor (differences: first minus second) [SIMULATED]
  class  adaptive  tv-gabor  difference     dB
  bark     100.0%     50.0%       +50.0  +3.01
  cloth    100.0%     87.5%       +12.5  +0.58
  straw    100.0%    100.0%         0.0   0.00
  mean difference over 2 participants +20.8 points, 95 % interval [-100.0, +100.0]
  sign-flip p = 0.5; +1.01 dB (10 log10 of the ratio of means)

to bear in mind [SIMULATED]
  - tv-gabor: 1 trial without a response, counted as wrong; with them excluded 19 of 23 are correct.
  - Intervals of a class pool all participants' trials as if they were independent, so they are too
    narrow; the interval to quote is that of the mean over participants.
  - adaptive: all participants have the same accuracy; the interval's zero width is no certainty.
  - adaptive: information transfer from 24 trials is biased upward; 45 are the usual minimum for 3
    classes.
  - tv-gabor: information transfer from 23 trials is biased upward; 45 are the usual minimum for 3
    classes.
  - adaptive: everything was right, so that d' has a lower bound alone and differences cannot show.
  - 2 participants are few: the design can show large effects alone, how people differ hardly at
    all, and the t interval leans on normality.
  - With 2 participants the sign-flip p cannot fall below 0.5, whatever the methods do.
  - The comparison holds for these 3 images; it does not generalise over images.

SIMULATED: these figures come from simulated participants.
)");
}

}  // namespace touchtrial
