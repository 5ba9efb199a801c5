#include "protocols/identification/analysis/report.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "analysis/text_table.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
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

std::string terminal_text(const analysis::identification::StudyReport& report,
                          std::size_t width = analysis::kTextWidth) {
  return analysis::document_text(analysis::identification::study_document(report, {}), width);
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

TEST_CASE("A report of an open study without sessions has no numbers and says so") {
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

TEST_CASE("Sessions that are left out are reported") {
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
        "study protocol simulated stamp simulated_on unverified_device state interim "
        "question_alone pilot "
        "participants trials "
        "classes methods "
        "comparison warnings "
        "pairs "
        "accuracy_intervals reaction_times registration collection references registered primary "
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
  FakeStudy study(design::identification::comparison(), {.simulated = false});
  const analysis::identification::StudyReport report = small_comparison(study);
  CHECK_FALSE(contains(analysis::identification::report_json(report), "SIMULATED"));
  CHECK_FALSE(contains(terminal_text(report), "SIMULATED"));
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
  const std::string text = terminal_text(report);
  const std::locale before = std::locale::global(std::locale(std::locale(), new Commas));
  const bool same =
      analysis::identification::report_json(report) == json && terminal_text(report) == text;
  std::locale::global(before);
  CHECK(same);
}

TEST_CASE("Every table of a simulated report is stamped and fits the terminal") {
  FakeStudy study(design::identification::comparison(),
                  {.label = "an uncommonly long label for one texture"});
  const analysis::identification::StudyReport report = small_comparison(study);
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

TEST_CASE("The terminal's report keeps its layout") {
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
  const std::string text = terminal_text(
      analysis::identification::make_report(analysis::load_outcomes(study.store(), study.key())));
  CHECK(text ==
        R"(simulated on: ideal device (no such device is sold)
SIMULATED: these numbers come from simulated participants. They say what a model of a hand and of a
sense of touch does, not what people do.
Report of the study pair [SIMULATED]

Result [SIMULATED]
------------------
  Not registered. Mean over participants of the accuracy with adaptive less that with tv-gabor:
  +12.5 points (2 participants analysed; no number planned, 2 completed). Period-adjusted t test
  over participants, two-sided, alpha 0.05. The study file registers no estimand and no test, so
  nothing is decided here.
  1 had the first method first, 1 had it last. Second period less first, whichever the method: −20.8
  points. Check by dealing the orders anew within the blocks in which they were dealt: p = 1.000;
  the least p that they could give is 1. What the first method leaves behind for the second
  (carry-over) is confounded with the order: it is not tested, and never chooses the analysis.

[SIMULATED] The deciding question under every choice of sessions and trials
                                                difference     t 95%
  choice                  participants  trials    (points)  (points)  p
  every session that                 2      48      *+12.5         –  –
  counts
  exclusions as made,                2      47       +16.7         –  –
  trials with a response
  alone
  p belongs to the first row alone; the others show what a choice changes. Each participant weighs
  the same, however many trials it has. Intervals are cut where possible values end.
  The same numbers as "every session that counts": all exclusions as made; exclusions made after
  outcomes were seen put back; all excluded sessions put back; exclusions as made, valid trials
  alone.

Participants [SIMULATED]
------------------------

[SIMULATED] How many people took part
                                                                      in the
  number of        planned  enrolled  completed  excluded  withdrew  results
  participants  not stated         2          2         0         0        2
  Completed: with those who were left out afterwards. In the results: after all exclusions as they
  were made; the sections below are about these.

[SIMULATED] Participants from enrolment to analysis, each counted once, by the session that was not
            replaced
  2 participants enrolled
  2 participants analysed
  sessions: 2
  dates: none: no session was in real time
  order: shuffled, 4 presentations of each stimulus
  exploration: at most 60 s, then: fade
  vision kept out by: curtain
  masking noise: −30 dBFS
  device: simulated (2 sessions)
  No deviation from the protocol was recorded.

[SIMULATED] When outcomes were looked at
  date                  participants  look   why
  1970-01-01 00:00 UTC             2  final  planned

Exploration [SIMULATED]
-----------------------

[SIMULATED] adaptive: how hands explored, over the trials that count
                                      lower             upper
  what                     trials  quartile  median  quartile
  time until answer (s)        23       4.2     4.2       4.2
  time in contact (s)          24       4.0     4.0       4.0
  path in contact (mm)         24       300     300       300
  speed in contact (mm/s)      24        75      75        75
  force, rms (N)               24      0.12    0.12      0.12
  at the force limit (%)       24       0.7     1.2       1.8
  Trials of all participants pooled, each with the same weight. 60 s were allowed; 1 of 24 trials
  ended without a response. Path, speed, force: in contact; speed: a trial's path over its time
  there. At the force limit: share of the time in contact.

[SIMULATED] tv-gabor: how hands explored, over the trials that count
                                      lower             upper
  what                     trials  quartile  median  quartile
  time until answer (s)        24       4.2     4.2       4.2
  time in contact (s)          24       4.0     4.0       4.0
  path in contact (mm)         24       300     300       300
  speed in contact (mm/s)      24        75      75        75
  force, rms (N)               24      0.12    0.12      0.12
  at the force limit (%)       24       0.7     1.2       1.8
  Trials of all participants pooled, each with the same weight. 60 s were allowed; 0 of 24 trials
  ended without a response. Path, speed, force: in contact; speed: a trial's path over its time
  there. At the force limit: share of the time in contact.

What to bear in mind [SIMULATED]
--------------------------------
  - adaptive: 1 trial without a response, counted as wrong; with them excluded 23 of 23 are correct.
  - Wilson, Clopper-Pearson and Jeffreys intervals pool all participants' trials as if they were
    independent, so they are too narrow; the intervals to quote are those over participants.
  - adaptive: information transfer from 23 trials is biased upward; 45 are the usual minimum for 3
    classes.
  - tv-gabor: information transfer from 24 trials is biased upward; 45 are the usual minimum for 3
    classes.
  - adaptive: 95.8% right is close to the ceiling; d' and differences there hang on few trials.
  - 2 participants are few: the design can show large effects alone, how people differ hardly at
    all, and the t interval leans on normality.
  - With 2 participants the sign-flip p cannot fall below 0.5, whatever the methods do.
  - Methods came one after the other. The deciding test adjusts for the period; differences and sign
    flips in the comparison of methods do not: learning or fatigue widens intervals and raises p.
  - The comparison holds for these 3 images; it does not generalise over images.

Accuracy [SIMULATED]
--------------------
  adaptive: participants were right in 95.8% of their trials on average (2 participants, 24 trials;
  95% t interval [42.9, 100.0], bootstrap interval [91.7, 100.0]; standard deviation between
  participants 1.3 [0.0, 20.0] points, without what a limited number of trials adds by chance).
  Chance is 33.3%. Whether at least one participant can: answers that have nothing to do with what
  was presented would give 7.7 right of 24 on average; 23 were right (exact permutation over the
  design, one-sided p < 0.001). 2 of 2 participants passed this test on their own trials; somebody
  who guesses passes with a probability of 3.5%. Estimated share of people who would pass in as many
  trials: 100.0% [34.5, 100.0], a lower bound of those who can.
  tv-gabor: participants were right in 83.3% of their trials on average (2 participants, 24 trials;
  95% t interval [0.0, 100.0], which is every possible value, bootstrap interval [66.7, 100.0];
  standard deviation between participants 21.9 [0.0, 37.3] points, without what a limited number of
  trials adds by chance). Chance is 33.3%. Whether at least one participant can: answers that have
  nothing to do with what was presented would give 8.0 right of 24 on average; 20 were right (exact
  permutation over the design, one-sided p < 0.001). 2 of 2 participants passed this test on their
  own trials; somebody who guesses passes with a probability of 3.0%. Estimated share of people who
  would pass in as many trials: 100.0% [34.9, 100.0], a lower bound of those who can.

[SIMULATED] Proportion of right answers, mean over participants
                                                         bootstrap 95%        SD between
  method    participants  trials    mean      t 95% (%)            (%)          (points)
  adaptive             2      24  *95.8%  [42.9, 100.0]  [91.7, 100.0]   1.3 [0.0, 20.0]
  tv-gabor             2      24  *83.3%   [0.0, 100.0]  [66.7, 100.0]  21.9 [0.0, 37.3]
  Each participant weighs the same, however many trials it has. A trial without a response counts as
  wrong. Chance is 33.3%.

[SIMULATED] Whether at least one participant can, and how many would show it
                             p, at              by
                       by    least  passed  chance   would
  method    right  chance      one   alone   alone    pass        95% (%)
  adaptive  23/24     7.7  < 0.001     2/2    3.5%  100.0%  [34.5, 100.0]
  tv-gabor  20/24     8.0  < 0.001     2/2    3.0%  100.0%  [34.9, 100.0]

[SIMULATED] adaptive: right answers by the texture presented; t over participants, the other
            intervals as if all trials were independent
                                                Wilson 95%  Clopper-Pearson   Jeffreys 95%
  texture  n  right  accuracy     t 95% (%)            (%)          95% (%)            (%)
  bark     8      8    100.0%             –  [67.6, 100.0]    [63.1, 100.0]  [73.8, 100.0]
  cloth    8      7     87.5%  [0.0, 100.0]   [52.9, 97.8]     [47.3, 99.7]   [54.6, 98.6]
  straw    8      8    100.0%             –  [67.6, 100.0]    [63.1, 100.0]  [73.8, 100.0]

[SIMULATED] adaptive: right answers by participant
                                    with the best
                                      exchange of            p of the            consistency
  participant   n  right  accuracy         labels  exchange  exchange  adjusted        (bit)
  P01          12     12    100.0%         100.0%  none         1.000     1.000         1.58
  Ann+1        12     11     91.7%          91.7%  none         1.000     1.000         1.57
  all, pooled  24     23     95.8%          95.8%  none             –         –            –

[SIMULATED] tv-gabor: right answers by the texture presented; t over participants, the other
            intervals as if all trials were independent
                                                Wilson 95%  Clopper-Pearson   Jeffreys 95%
  texture  n  right  accuracy     t 95% (%)            (%)          95% (%)            (%)
  bark     8      4     50.0%  [0.0, 100.0]   [21.5, 78.5]     [15.7, 84.3]   [19.9, 80.1]
  cloth    8      8    100.0%             –  [67.6, 100.0]    [63.1, 100.0]  [73.8, 100.0]
  straw    8      8    100.0%             –  [67.6, 100.0]    [63.1, 100.0]  [73.8, 100.0]

[SIMULATED] tv-gabor: right answers by participant
                                    with the best
                                      exchange of            p of the            consistency
  participant   n  right  accuracy         labels  exchange  exchange  adjusted        (bit)
  P01          12      8     66.7%          66.7%  none         1.000     1.000         0.92
  Ann+1        12     12    100.0%         100.0%  none         1.000     1.000         1.58
  all, pooled  24     20     83.3%          83.3%  none             –         –            –

Confusions [SIMULATED]
----------------------

[SIMULATED] adaptive: answers (columns) to the textures presented (rows), counts and row percentages
                                                     no
  presented         bark     cloth      straw  response   n
  bark         *8 (100%)         0          0         0   8
  cloth                0  *7 (88%)          0   1 (12%)   8
  straw                0         0  *8 (100%)         0   8
  all answers    8 (33%)   7 (29%)    8 (33%)    1 (4%)  24
  All participants' trials pooled; right answers are emphasised. The last row counts each answer,
  whatever was presented; it shows preferences for answers.

[SIMULATED] adaptive: unbiased hit rates, which answering one texture often does not raise
                                           at
  texture        mean       t 95% (%)  random
  bark         100.0%  [100.0, 100.0]   15.2%
  cloth         87.5%    [0.0, 100.0]   14.0%
  straw        100.0%  [100.0, 100.0]   15.2%
  mean of all  *95.8%   [42.9, 100.0]   14.8%

[SIMULATED] adaptive: similarity of textures, and bias of answers
  similarity   bark  cloth  straw
  bark        1.000  0.000  0.000
  cloth       0.000  1.000  0.000
  straw       0.000  0.000  1.000
  bias        1.000  1.000  1.000
  No degree of freedom is left to test the fit.
  Only within the 3 groups {bark}, {cloth} and {straw} were textures taken for each other both ways:
  between groups no similarity can be told from a bias, and biases cannot be compared.

[SIMULATED] tv-gabor: answers (columns) to the textures presented (rows), counts and row percentages
                                                     no
  presented        bark      cloth      straw  response   n
  bark         *4 (50%)          0    4 (50%)         0   8
  cloth               0  *8 (100%)          0         0   8
  straw               0          0  *8 (100%)         0   8
  all answers   4 (17%)    8 (33%)   12 (50%)         0  24
  All participants' trials pooled; right answers are emphasised. The last row counts each answer,
  whatever was presented; it shows preferences for answers.

[SIMULATED] tv-gabor: unbiased hit rates, which answering one texture often does not raise
                                           at
  texture        mean       t 95% (%)  random
  bark          50.0%    [0.0, 100.0]    7.6%
  cloth        100.0%  [100.0, 100.0]   15.2%
  straw         75.0%    [0.0, 100.0]   19.7%
  mean of all  *75.0%    [0.0, 100.0]   14.1%

[SIMULATED] tv-gabor: similarity of textures, and bias of answers
  similarity   bark  cloth  straw
  bark        1.000  0.000      –
  cloth       0.000  1.000  0.000
  straw           –  0.000  1.000
  bias        1.000  1.000  1.000
  No degree of freedom is left to test the fit.
  Only within the 3 groups {bark}, {cloth} and {straw} were textures taken for each other both ways:
  between groups no similarity can be told from a bias, and biases cannot be compared.

[SIMULATED] Information transfer and nominal sensitivity, all participants' trials pooled
                                      at
                  raw  corrected  random
  method     n  (bit)      (bit)   (bit)  categories    d′          d′ 95%
  adaptive  23   1.58       1.46    0.16         2.7  2.83  [1.60, 4.62] *
  tv-gabor  24   1.13       1.01    0.14         2.0  1.82  [0.97, 2.74] *
  * From Clopper and Pearson's interval, which treats trials as independent: there are fewer than
  six participants, or they do not differ.

Comparison of methods [SIMULATED]
---------------------------------
  adaptive less tv-gabor: +12.5 percentage points (mean of 2 participants; 95% t interval [−100.0,
  100.0]; sign-flip p = 1.000). As a ratio of the two means that is +0.61 dB (10 log10, the decibel
  of power); odds ratio 4.00 [0.49, 32.91] †.

[SIMULATED] Methods compared within participants
                                                                    bootstrap  sign-flip
  difference              participants  points            t 95%           95%          p
  adaptive less tv-gabor             2  *+12.5  [−100.0, 100.0]  [−8.3, 33.3]      1.000
                                                dB (10
  difference                   odds ratio, 95%  log10)
  adaptive less tv-gabor  4.00 [0.49, 32.91] †   +0.61
  dB: 10 log10 of the ratio of the two means; 20 log10 would be twice that.
  The deciding test is another one; it stands under "Result".

[SIMULATED] adaptive beside tv-gabor, by texture
           adaptive,            tv-gabor,                                     sign-flip  dB (10
  texture      right  adaptive      right  tv-gabor  points            t 95%          p  log10)
  bark           8/8    100.0%        4/8     50.0%   +50.0  [−100.0, 100.0]      1.000   +3.01
  cloth          7/8     87.5%        8/8    100.0%   −12.5  [−100.0, 100.0]      1.000   −0.58
  straw          8/8    100.0%        8/8    100.0%     0.0     [0.0, 0.0] *      1.000    0.00
  * Every participant has the same difference, so that the interval has no width: it does not show
  how certain the number is.
  What this design cannot show: it holds 3 textures, and the same ones for everybody, so that a
  difference may belong to these textures and does not generalise to others, however small its p.
  With 2 participants the two-sided sign-flip p cannot fall below 0.5, and so never below 0.05.
  Absence of a difference is not shown by a p that is not small; the interval says which differences
  remain possible.

Reaction times [SIMULATED]
--------------------------

[SIMULATED] adaptive: reaction times in seconds by the texture presented: quartiles and medians
               plane   plane  plane
                 on,     on,    on,  contact,  contact,  contact,
  texture   n    25%  median    75%       25%    median       75%
  bark      8   4.25    4.25   4.25      3.75      3.75      3.75
  cloth     7   4.25    4.25   4.25      3.75      3.75      3.75
  straw     8   4.25    4.25   4.25      3.75      3.75      3.75
  all      23   4.25    4.25   4.25      3.75      3.75      3.75

[SIMULATED] tv-gabor: reaction times in seconds by the texture presented: quartiles and medians
               plane   plane  plane
                 on,     on,    on,  contact,  contact,  contact,
  texture   n    25%  median    75%       25%    median       75%
  bark      8   4.25    4.25   4.25      3.75      3.75      3.75
  cloth     8   4.25    4.25   4.25      3.75      3.75      3.75
  straw     8   4.25    4.25   4.25      3.75      3.75      3.75
  all      24   4.25    4.25   4.25      3.75      3.75      3.75

Which cue was it? [SIMULATED]
-----------------------------
  Not examined: ideal observers read every trace of the study. Ask for it with touchtrial report DB
  --out DIR --cues yes.

Servo and validity [SIMULATED]
------------------------------
  There is no table and no figure of the servo: no trial ran in real time. In virtual time every
  tick is on time by construction, and says nothing about a device.

[SIMULATED] adaptive: the mean accuracy with other choices of trials
  trials                   n  right  pooled  participants    mean       t 95% (%)
  as counted (a missing   24     23   95.8%             2   95.8%   [42.9, 100.0]
  response is wrong)
  trials without a        23     23  100.0%             2  100.0%  [100.0, 100.0]
  response left out
  trials that break the   24     23   95.8%             2   95.8%   [42.9, 100.0]
  validity rule left out
  excluded participants'  24     23   95.8%             2   95.8%   [42.9, 100.0]
  sessions put back

[SIMULATED] tv-gabor: the mean accuracy with other choices of trials
  trials                   n  right  pooled  participants   mean     t 95% (%)
  as counted (a missing   24     20   83.3%             2  83.3%  [0.0, 100.0]
  response is wrong)
  trials without a        24     20   83.3%             2  83.3%  [0.0, 100.0]
  response left out
  trials that break the   24     20   83.3%             2  83.3%  [0.0, 100.0]
  validity rule left out
  excluded participants'  24     20   83.3%             2  83.3%  [0.0, 100.0]
  sessions put back

This report [SIMULATED]
-----------------------
  protocol: comparison
  participants: 2
  trials: 48
  textures: bark, cloth and straw
  state: collecting, blind
  database:
  seal of the study:
  head of the file's chain: 0000000000000000000000000000000000000000000000000000000000000000
    (event 0)
  program: touchtrial

SIMULATED
)");
}

}  // namespace touchtrial
