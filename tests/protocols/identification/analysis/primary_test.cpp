#include "analysis/choices/primary.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/report/page/document.hpp"
#include "analysis/text_matching.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using namespace analysis::identification;
using namespace choices;
using analysis::Verdict;
using std::chrono::seconds;

constexpr const char* kRegistered =
    R"({"hypothesis": "They can.", "participants": 20, "estimand": "mean-accuracy",
        "smallest_effect": 0.5, "exclusion_rules": {"own_deviations": ["asleep"]}})";

/// The first `right` of the 12 trials are right, the others wrong.
FakeAnswers right_in(int right) {
  return [right](const study::Trial& shown) {
    const int shift = shown.place.trial <= right ? 0 : 1;
    return std::optional((shown.field().class_index + shift) % 3);
  };
}

void add_people(FakeStudy& study, int first, const std::vector<int>& right) {
  for (const int of_twelve : right) {
    study.add({.participant = "P" + std::to_string(first),
               .enrolment = first,
               .answers = right_in(of_twelve)});
    ++first;
  }
}

StudyReport report_of(FakeStudy& study) {
  return make_report(analysis::load_outcomes(study.store(), study.key()));
}

StudyReport final_report_of(FakeStudy& study) {
  study.close_and_unblind();
  return report_of(study);
}

/// What a look at the registered question alone is made of.
StudyReport answer_of(FakeStudy& study) {
  return make_report(analysis::load_outcomes_for_question(study.store(), study.key()));
}

nlohmann::json json_of(const StudyReport& report) {
  return nlohmann::json::parse(report_json(report));
}

const analysis::PrimaryChoice& choice_of(const StudyReport& report, const std::string& name) {
  const auto& choices = report.primary.value().choices;
  return *std::ranges::find(choices, name, &analysis::PrimaryChoice::name);
}

std::string terminal_text(const StudyReport& report) {
  return analysis::document_text(study_document(report, {}));
}

std::string on_one_line(const std::string& text) {
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

/// A primary result by hand, of a study that collected the planned number and is closed.
struct Judged {
  explicit Judged(double null, int people = 20)
      : course{.planned = people,
               .completed = people,
               .analysed = people,
               .closed = true,
               .has_registration = true} {
    result.null = null;
    at(0.6, {0.5, 0.7}, 0.001);
  }
  void at(double estimate, analysis::Interval interval, double p) {
    result.choices = {{"registered", "", course.analysed, 500, estimate, interval}};
    result.p = p;
  }
  [[nodiscard]] Verdict verdict() {
    analysis::set_verdict(result, course);
    return result.verdict;
  }
  [[nodiscard]] Verdict verdict(double estimate, analysis::Interval interval, double p) {
    at(estimate, interval, p);
    return verdict();
  }

  analysis::PrimaryResult result;
  analysis::StudyCourse course;
};

/// Two looks, three exclusions after them, and 14 of 20 participants.
StudyReport looked_at(FakeStudy& study) {
  add_people(study, 1, {8, 7, 9, 2, 1});
  study.store().unblind(seconds(1'769'860'800), "curious", true);
  add_people(study, 6, {8, 6, 7, 9});
  study.store().unblind(seconds(1'769'947'200), "a grant report", true);
  add_people(study, 10, {9, 8, 2, 7, 8});
  for (const int session : {4, 5, 8}) {
    study.store().exclude(session, seconds(1'770'000'000), "guessed");
  }
  return final_report_of(study);
}

}  // namespace

TEST_CASE("a study with looks, late exclusions and too few participants says all of it") {
  FakeStudy study({.registration = kRegistered});
  const StudyReport report = looked_at(study);
  REQUIRE(report.primary.has_value());
  CHECK(report.primary->verdict == Verdict::undecided);
  CHECK(report.participants == 11);
  CHECK(choice_of(report, "registered").participants == 14);
  CHECK(choice_of(report, "taken").participants == 11);
  const std::string text = terminal_text(report);
  const std::string screen = on_one_line(text.substr(0, text.find("\nAccuracy")));
  for (const char* part : {"14 20 11", "2026-01-31 12:00 5", "2026-02-01 12:00 9", "curious",
                           "a grant report", "P4 P5 P8 guessed"}) {
    INFO(screen);
    CHECK(names(screen, part));
  }
  CHECK(report.departures.size() == 5);
}

TEST_CASE("report --json holds what was registered, the answer, looks and departures") {
  FakeStudy study({.registration = kRegistered});
  const nlohmann::json json = json_of(looked_at(study));
  CHECK(json["registered"]["estimand"] == "mean-accuracy");
  CHECK(json["registered"]["test"] == "t");
  CHECK(json["registered"]["alpha"] == 0.05);
  CHECK(json["registered"]["participants"] == 20);
  CHECK(json["registered"]["looks"].empty());
  CHECK(json["primary"]["verdict"] == "undecided");
  CHECK(json["primary"]["choices"].size() == 6);
  CHECK(json["primary"]["excluded_after_outcomes"] == 3);
  CHECK(names(json["collection"]["sessions"][3]["exclusion_reason"].get<std::string>(), "guessed"));
  CHECK(names(json["primary"]["p_note"].get<std::string>(), "2"));
  REQUIRE(json["looks"].size() == 3);
  CHECK(json["looks"][0]["at"] == "2026-01-31T12:00:00Z");
  CHECK(json["looks"][0]["participants"] == 5);
  CHECK(json["looks"][0]["reason"] == "curious");
  CHECK(json["departures"].size() == 5);
  CHECK(json["prevalence"]["interval"].size() == 2);
}

TEST_CASE("people who are all alike are tested by sign flips, and the test is called so") {
  FakeStudy study({.registration = R"({"participants": 4, "estimand": "mean-accuracy"})"});
  add_people(study, 1, {8, 8, 8, 8});
  const StudyReport report = final_report_of(study);
  const analysis::PrimaryResult& primary = *report.primary;
  CHECK(primary.p == 1.0 / 16.0);
  CHECK_FALSE(primary.registered().interval);
  FakeStudy differing({.registration = R"({"participants": 4, "estimand": "mean-accuracy"})"});
  add_people(differing, 1, {8, 7, 8, 8});
  CHECK(primary.test != final_report_of(differing).primary->test);
  CHECK_FALSE(report.methods[0].mean.known_interval());
}

TEST_CASE("the primary result is the t test of participants' accuracies against chance") {
  FakeStudy study({.registration = R"({"participants": 6, "estimand": "mean-accuracy"})"});
  add_people(study, 1, {8, 7, 6, 9, 5, 4});
  const StudyReport report = final_report_of(study);
  const analysis::PrimaryResult& primary = *report.primary;
  const std::vector<double> shares = {8 / 12.0, 7 / 12.0, 6 / 12.0, 9 / 12.0, 5 / 12.0, 4 / 12.0};
  CHECK(primary.p == analysis::t_test_p(shares, 1.0 / 3.0, analysis::Sides::one));
  CHECK(primary.registered().estimate == report.methods[0].mean.mean);
  CHECK(primary.registered().interval == report.methods[0].mean.interval);
  CHECK(primary.verdict == Verdict::supported);
  CHECK(primary.bound.value() > primary.registered().interval->low);
  CHECK(report.departures.empty());
}

TEST_CASE("a study file without the fields registers nothing") {
  FakeStudy study(study::identification::classification());
  add_people(study, 1, {8, 7, 6, 9, 5, 4});
  const nlohmann::json json = json_of(final_report_of(study));
  CHECK(json["registered"].is_null());
  CHECK(json["primary"]["verdict"] == "not registered");
  CHECK(json["departures"].empty());
}

TEST_CASE("exclusions are held against the registered rules") {
  FakeStudy study({.registration = R"({"participants": 5, "estimand": "mean-accuracy",
                                       "exclusion_rules": {"own_deviations": ["asleep"]}})"});
  add_people(study, 1, {8, 7, 6, 9, 5});
  study.store().note(1, seconds(5), "asleep", "snored");
  study.store().note(2, seconds(5), "asleep", "snored too");
  study.store().exclude(2, seconds(6), "asleep");
  study.store().exclude(3, seconds(6), "slow");
  const StudyReport report = final_report_of(study);
  std::string all;
  for (const std::string& one : report.departures) all += one + "\n";
  CHECK_THAT(all, names("1 P3 slow"));
  CHECK_THAT(all, names("1 P1 asleep"));
  CHECK(choice_of(report, "registered").participants == 2);
  CHECK(choice_of(report, "taken").participants == 3);
  CHECK(choice_of(report, "all").participants == 5);
}

TEST_CASE("an effect may be excluded, reached or open") {
  Judged judged(0.2);
  analysis::PrimaryResult& result = judged.result;
  result.smallest_effect = 0.4;
  const auto verdict = [&](double estimate, analysis::Interval interval, double p) {
    return judged.verdict(estimate, interval, p);
  };
  CHECK(verdict(0.6, {0.5, 0.7}, 0.001) == Verdict::supported);
  CHECK_THAT(result.reason, names("40.0%"));
  CHECK(result.reason.starts_with("p < 0.05. "));
  CHECK(verdict(0.6, {0.5, 0.7}, 0.05) == Verdict::supported);
  CHECK(result.reason.starts_with("p = 0.05"));
  CHECK(verdict(0.6, {0.5, 0.7}, 0.04999) == Verdict::supported);
  CHECK(result.reason.starts_with("p = 0.04999000 < 0.05. "));
  CHECK(verdict(0.25, {0.21, 0.29}, 0.01) == Verdict::supported);
  CHECK_THAT(result.reason, names("40.0%"));
  CHECK(verdict(0.3, {0.15, 0.45}, 0.2) == Verdict::undecided);
  CHECK(result.reason.starts_with("p > 0.05. "));
  CHECK(verdict(0.2, {0.15, 0.25}, 0.5) == Verdict::not_supported);
  result.sides = analysis::Sides::two;
  CHECK(verdict(0.1, {0.05, 0.15}, 0.001) == Verdict::not_supported);
}

TEST_CASE("an interval without width, or cut where possible values end, is said to be so") {
  Judged judged(0.2, 2);
  analysis::PrimaryResult& result = judged.result;
  result.smallest_effect = 0.4;
  const auto because = [&](double estimate, analysis::Interval interval, double p) {
    static_cast<void>(judged.verdict(estimate, interval, p));
    return result.reason;
  };
  const std::string unbounded = because(0.9, {0.1, 1.0}, 0.03);
  CHECK(because(0.7, {0.0, 1.0}, 0.2) != because(0.7, {0.1, 0.9}, 0.2));
  result.bound = 0.48;
  CHECK_THAT(because(0.9, {0.1, 1.0}, 0.03), names("48.0%"));
  CHECK(because(0.9, {0.1, 1.0}, 0.03) != unbounded);
  CHECK(because(0.9, {0.7, 1.0}, 0.01).size() > because(0.6, {0.5, 0.7}, 0.01).size());
  CHECK_FALSE(because(1.0, {1.0, 1.0}, 0.25).empty());
  CHECK(result.verdict == Verdict::undecided);
}

TEST_CASE("more participants than planned are said, and decide nothing after a look") {
  Judged judged(0.2, 25);
  judged.course.planned = 20;
  CHECK(judged.verdict() == Verdict::supported);
  CHECK_THAT(judged.result.reason, names("25 5"));
  judged.course.registered_looks = {10};
  CHECK(judged.verdict() == Verdict::undecided);
  CHECK_THAT(judged.result.reason, names("5 20"));
  judged.result.p = 0.3;
  CHECK(judged.verdict() == Verdict::not_supported);
}

TEST_CASE("the first row speaks of late exclusions if there were any") {
  FakeStudy study({.registration = kRegistered});
  const std::string looked = choice_of(looked_at(study), "registered").words;
  FakeStudy plain({.registration = kRegistered});
  add_people(plain, 1, {8, 7, 9});
  plain.store().exclude(3, seconds(6), "ill");
  CHECK(choice_of(final_report_of(plain), "registered").words != looked);
}

TEST_CASE("a look far too early has a level, and an interval of it") {
  FakeStudy study(
      {.registration = R"({"participants": 100, "estimand": "mean-accuracy", "looks": [2]})"});
  add_people(study, 1, {11, 12});
  study.store().look_at_question(seconds(10), "as registered");
  const StudyReport report = answer_of(study);
  CHECK(report.primary->level == 1e-9);
  CHECK(report.primary->verdict == Verdict::undecided);
  CHECK(contains(on_one_line(terminal_text(report)), "99.9999999% t interval [0.0, 100.0]"));
}

TEST_CASE("p within its level decides nothing after an unregistered look or before the end") {
  Judged judged(0.2);
  judged.course.unregistered_looks = 1;
  CHECK(judged.verdict() == Verdict::undecided);
  judged.result.p = 0.3;
  CHECK(judged.verdict() == Verdict::not_supported);
  judged.result.p = 0.001;
  judged.course.unregistered_looks = 0;
  judged.course.closed = false;
  CHECK(judged.verdict() == Verdict::undecided);
  judged.course.at_registered_look = true;
  CHECK(judged.verdict() == Verdict::supported);
  judged.course.pilot = true;
  CHECK(judged.verdict() == Verdict::not_registered);
}

TEST_CASE("a registered look has Lan and DeMets's level, and so has the end after it") {
  FakeStudy study(
      {.registration = R"({"participants": 8, "estimand": "mean-accuracy", "looks": [4]})"});
  add_people(study, 1, {5, 4, 6, 5});
  study.store().look_at_question(seconds(10), "as registered");
  CHECK(answer_of(study).primary->level == Approx(0.0055745966).epsilon(1e-5));
  add_people(study, 5, {5, 4, 6, 5});
  const StudyReport report = final_report_of(study);
  CHECK(report.primary->level == Approx(0.0482457031).epsilon(1e-5));
  CHECK(report.departures.empty());
}

TEST_CASE("a registered look may end collecting, and its interval has the level of its test") {
  FakeStudy study(
      {.registration = R"({"participants": 8, "estimand": "mean-accuracy", "looks": [4]})"});
  add_people(study, 1, {11, 12, 11, 12});
  study.store().look_at_question(seconds(10), "as registered");
  const StudyReport look = answer_of(study);
  CHECK(look.primary->verdict == Verdict::supported);
  CHECK(look.primary->interval_level == Approx(1.0 - 0.0055745966));
  CHECK_THAT(look.primary->reason, names("4"));
  analysis::Provenance provenance;
  provenance.state = study.store().state();
  CHECK_THAT(analysis::document_text(study_document(look, provenance)), holds_text("INTERIM LOOK"));
  const StudyReport report = final_report_of(study);
  CHECK(report.primary->verdict == Verdict::supported);
  CHECK(report.primary->reason != look.primary->reason);
  CHECK(report.departures.empty());
}

TEST_CASE("without a registered number of participants a p within its level decides nothing") {
  FakeStudy study({.registration = R"({"estimand": "mean-accuracy"})"});
  add_people(study, 1, {11, 12, 11, 12});
  const StudyReport report = final_report_of(study);
  CHECK(report.primary->p.value() < 0.001);
  CHECK(report.primary->verdict == Verdict::undecided);
  CHECK(report.departures.size() == 1);
}

TEST_CASE("a registered difference is the first method less the second") {
  FakeStudy study(study::identification::comparison(),
                  {.registration = R"({"participants": 3, "estimand": "difference",
                                       "methods": ["tv-gabor", "adaptive"], "sides": "one",
                                       "test": "sign-flip"})"});
  for (int i = 1; i <= 3; ++i) {
    study.add({.participant = "P" + std::to_string(i),
               .enrolment = i,
               .answers = [](const study::Trial& shown) {
                 const bool wrong = shown.field().method == 0 && shown.field().class_index == 0;
                 return std::optional(wrong ? 1 : shown.field().class_index);
               }});
  }
  const StudyReport report = final_report_of(study);
  CHECK(report.primary->registered().estimate.value() == Approx(1.0 / 3.0));
  CHECK(report.primary->p == 0.125);
  CHECK(report.primary->verdict == Verdict::not_supported);
}

namespace {

/// Two methods, one after the other: in the first block `early` of 12 trials are right, in the
/// second `late`, whichever the method.
FakeAnswers right_by_block(int early, int late) {
  return [early, late](const study::Trial& shown) {
    const int place = shown.place.block == 0 ? shown.place.trial : shown.place.trial - 12;
    const bool right = place <= (shown.place.block == 0 ? early : late);
    return std::optional(right ? shown.field().class_index : (shown.field().class_index + 1) % 3);
  };
}

void add_learners(FakeStudy& study, const std::vector<int>& enrolments) {
  for (const int enrolment : enrolments) {
    study.add({.participant = "P" + std::to_string(enrolment),
               .enrolment = enrolment,
               .answers = right_by_block(6 + enrolment % 3, 8 + enrolment % 2)});
  }
}

}  // namespace

TEST_CASE("in blocks by method an effect of the period is not one of the methods") {
  FakeStudy study(study::identification::comparison(),
                  {.registration = R"({"participants": 8, "estimand": "difference"})"});
  add_learners(study, {1, 2, 3, 4, 5, 6, 7, 8});
  const StudyReport report = final_report_of(study);
  const analysis::PrimaryResult& primary = *report.primary;
  REQUIRE(primary.crossover.has_value());
  CHECK(primary.crossover->first_first == 4);
  CHECK(primary.crossover->second_first == 4);
  // 1, 2, 0, 1, .. more than six, and 1, 0, 1, 0, .. more than eight, of twelve.
  CHECK(primary.crossover->period.value() == Approx(1.5 / 12.0).margin(0.05));
  // At most that, whoever of a pair was dealt which order.
  CHECK(std::abs(primary.registered().estimate.value()) < 0.08);
  CHECK(primary.registered().interval->high < 0.15);
  CHECK(primary.permutation->least == 2.0 / 16.0);
  CHECK(primary.permutation->p > 0.1);
  CHECK(primary.verdict == Verdict::not_supported);
  const std::string text = on_one_line(terminal_text(report));
  CHECK(names(text, "0.125"));
  const nlohmann::json json = json_of(report);
  CHECK(json["registered"]["test"] == "crossover");
  CHECK(json["primary"]["crossover"]["first_first"] == 4);
  CHECK(json["primary"]["crossover"]["least_p"] == 0.125);
  CHECK(json["primary"]["interval_level"] == 0.95);
}

TEST_CASE("with one order of methods alone nothing tells the method from the period") {
  FakeStudy study(study::identification::comparison(),
                  {.registration = R"({"participants": 3, "estimand": "difference"})"});
  std::vector<int> same_order;
  for (int enrolment = 1; enrolment <= 8 && same_order.size() < 3; ++enrolment) {
    if (study.key().draw_of(enrolment, study::Draws::rehearsal).method_order == 0) {
      same_order.push_back(enrolment);
    }
  }
  add_learners(study, same_order);
  const StudyReport report = final_report_of(study);
  CHECK(report.primary->verdict == Verdict::undecided);
  CHECK_FALSE(report.primary->p);
  CHECK_FALSE(report.primary->registered().estimate);
  CHECK_FALSE(report.primary->reason.empty());
}

TEST_CASE("a study of mixed blocks, and a registered test, have no period-adjusted one") {
  FakeStudy mixed(study::identification::comparison(),
                  {.trials = R"({"blocks": "mixed"})",
                   .registration = R"({"participants": 4, "estimand": "difference"})"});
  FakeStudy flips(study::identification::comparison(),
                  {.registration = R"({"participants": 4, "estimand": "difference",
                                       "test": "sign-flip"})"});
  for (FakeStudy* study : {&mixed, &flips}) {
    for (int i = 1; i <= 4; ++i) {
      study->add({.participant = "P" + std::to_string(i), .enrolment = i});
    }
    CHECK_FALSE(final_report_of(*study).primary->crossover);
  }
  CHECK(report_of(mixed).primary->test == report_of(flips).primary->test);
}

TEST_CASE("as good by a margin is judged by the interval above minus the margin") {
  Judged judged(-0.07);
  analysis::PrimaryResult& result = judged.result;
  result.estimand = study::Estimand::difference;
  result.margin = 0.07;
  result.interval_level = 0.9;
  const auto verdict = [&](analysis::Interval interval, double p) {
    return judged.verdict(0.5 * (interval.low + interval.high), interval, p);
  };
  CHECK(verdict({-0.05, 0.03}, 0.02) == Verdict::supported);
  CHECK_THAT(result.reason, names("90% 7.0 0"));
  const std::string holds_zero = result.reason;
  CHECK(verdict({0.01, 0.09}, 0.001) == Verdict::supported);
  CHECK(result.reason != holds_zero);
  const std::string better = result.reason;
  CHECK(verdict({-0.06, -0.01}, 0.01) == Verdict::supported);
  CHECK(result.reason != holds_zero);
  CHECK(result.reason != better);
  CHECK(verdict({-0.1, 0.02}, 0.2) == Verdict::undecided);
  CHECK_THAT(result.reason, names("7.0"));
  CHECK(verdict({-0.2, -0.1}, 0.99) == Verdict::not_supported);
  CHECK(result.reason != better);
}

TEST_CASE("methods that are not above chance are not as good as each other") {
  Judged judged(-0.07);
  analysis::PrimaryResult& result = judged.result;
  result.estimand = study::Estimand::difference;
  result.margin = 0.07;
  result.above_chance = {{"adaptive", 0.5, 0.001}, {"edge", 0.4, 0.04}};
  CHECK(judged.verdict(0.0, {-0.05, 0.05}, 0.02) == Verdict::supported);
  result.above_chance = {{"adaptive", 0.21, 0.3}, {"edge", 0.4, 0.04}};
  CHECK(judged.verdict(0.0, {-0.05, 0.05}, 0.02) == Verdict::undecided);
  CHECK_THAT(result.reason, names("adaptive 21.0% 0.3"));
  CHECK(judged.verdict(-0.2, {-0.25, -0.15}, 0.99) == Verdict::not_supported);
}

TEST_CASE("people who guess with both methods support nothing") {
  FakeStudy study(study::identification::comparison(),
                  {.registration = R"({"participants": 8, "estimand": "difference",
                                       "methods": ["tv-gabor", "adaptive"], "margin": 0.3})"});
  for (int enrolment = 1; enrolment <= 8; ++enrolment) {
    study.add({.participant = "P" + std::to_string(enrolment),
               .enrolment = enrolment,
               .answers = right_by_block(3 + enrolment % 3, 3 + (enrolment + 1) % 3)});
  }
  const StudyReport report = final_report_of(study);
  CHECK(report.primary->p.value() <= 0.05);
  CHECK(report.primary->verdict == Verdict::undecided);
  CHECK_FALSE(report.primary->reason.empty());
  CHECK(json_of(report)["primary"]["above_chance"].size() == 2);
}

TEST_CASE("a registered margin has the one-sided test and the 90 % interval") {
  FakeStudy study(study::identification::comparison(),
                  {.registration = R"({"participants": 8, "estimand": "difference",
                                       "methods": ["tv-gabor", "adaptive"], "margin": 0.2})"});
  add_learners(study, {1, 2, 3, 4, 5, 6, 7, 8});
  const StudyReport report = final_report_of(study);
  const analysis::PrimaryResult& primary = *report.primary;
  CHECK(primary.null == -0.2);
  CHECK(primary.interval_level == Approx(0.9));
  CHECK(primary.bound == primary.registered().interval->low);
  CHECK((primary.p.value() <= 0.05) == (primary.bound.value() > -0.2));
  CHECK(primary.verdict == Verdict::supported);
  const nlohmann::json json = json_of(report);
  CHECK(json["registered"]["margin"] == 0.2);
  CHECK(json["primary"]["margin"] == 0.2);
  CHECK(contains(on_one_line(terminal_text(report)), "against −20 points"));
}

}  // namespace touchtrial
