// The registered question about thresholds.
#include "analysis/report/page/document.hpp"
#include "analysis/report/results.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "protocols/threshold/analysis/hand_made_tracks.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"
#include "protocols/threshold/analysis/report.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace own = analysis::threshold;
using analysis::Verdict;
using study::Estimand;
using study::RegisteredAnalysis;

/// Participants with these thresholds of bark and of cloth, in dB.
HandMadeTracks two_textures(const std::vector<double>& bark, const std::vector<double>& cloth) {
  HandMadeTracks made(detection_options(), {"bark", "cloth"});
  const auto add = [&](int session, int track, double threshold) {
    RandomStream random(3, "threshold primary test",
                        static_cast<std::size_t>(10 * session + track));
    made.attended_track(session, track, {procedures::Shape::weibull, threshold, 3.5, 0.5, 0.01},
                        random);
  };
  for (std::size_t i = 0; i < bark.size(); ++i) {
    const int session = static_cast<int>(i) + 1;
    made.session();
    add(session, 1, bark[i]);
    add(session, 2, cloth[i]);
  }
  made.outcomes.design.registration.participants = static_cast<int>(bark.size());
  return made;
}

void register_question(HandMadeTracks& made, const RegisteredAnalysis& analysis) {
  made.outcomes.design.registration.analysis = analysis;
}

/// Excluded with knowledge of outcomes.
void exclude_late(HandMadeTracks& made, int session) {
  analysis::SessionOutcome& left = made.outcomes.sessions.at(static_cast<std::size_t>(session - 1));
  left.counted = false;
  left.row.excluded = true;
  made.outcomes.look_record.excluded_afterwards.insert(session);
}

const RegisteredAnalysis kBarkAlone{
    .estimand = Estimand::mean_threshold, .standards = {{"bark", {}}}, .one_sided = false};
const RegisteredAnalysis kDifference{.estimand = Estimand::threshold_difference,
                                     .one_sided = false};

RegisteredAnalysis equality(double margin_db) {
  return {.estimand = Estimand::threshold_equality, .margin = margin_db};
}

const analysis::PrimaryChoice& choice_of(const own::ThresholdReport& report, const char* name) {
  return *std::ranges::find(report.primary.value().choices, name, &analysis::PrimaryChoice::name);
}

const std::vector<double> kBark = {-22.0, -20.0, -18.0, -24.0, -21.0, -19.0};
const std::vector<double> kSofter = {-28.0, -27.0, -25.0, -30.0, -26.0, -27.0};
const std::vector<double> kAlike = {-21.0, -21.0, -18.0, -23.0, -22.0, -19.0};

}  // namespace

TEST_CASE("a registered mean is an estimate, and a late exclusion shows as a row of its own") {
  HandMadeTracks made = two_textures(kBark, kSofter);
  register_question(made, kBarkAlone);
  const own::ThresholdReport before = own::make_report(made.outcomes);
  CHECK(before.primary->verdict == Verdict::estimated);
  CHECK_FALSE(before.primary->p);
  CHECK(before.departures.empty());
  exclude_late(made, 4);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK(choice_of(report, "registered").participants == 6);
  CHECK(choice_of(report, "registered").estimate == choice_of(before, "registered").estimate);
  CHECK(choice_of(report, "put_back").participants == 6);
  CHECK(choice_of(report, "all").participants == 6);
  CHECK(choice_of(report, "taken").participants == 5);
  CHECK(choice_of(report, "taken").estimate > choice_of(report, "put_back").estimate);
  CHECK_THAT(report.departures.at(0), names("1"));
  const std::string text = analysis::document_text(own::threshold_document(report, {}));
  const nlohmann::json json = nlohmann::json::parse(own::report_json(report));
  CHECK(json["primary"]["verdict"] == "estimated");
  CHECK(json["primary"]["unit"] == "dB");
  CHECK(json["primary"]["p"].is_null());
  CHECK(json["primary"]["null"].is_null());
  CHECK(json["primary"]["choices"].size() == 5);
  CHECK(json["registered"]["standards"][0]["class"] == "bark");
}

TEST_CASE("a registered difference of thresholds is the t test of those who have both") {
  HandMadeTracks made = two_textures(kBark, kSofter);
  register_question(made, kDifference);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  std::vector<double> differences;
  for (std::size_t i = 0; i < report.standards[0].thresholds.size(); ++i) {
    const analysis::Bounds& bark = report.standards[0].thresholds[i].bounds;
    const analysis::Bounds& cloth = report.standards[1].thresholds[i].bounds;
    REQUIRE((bark.exact() && cloth.exact()));
    differences.push_back(bark.low - cloth.low);
  }
  REQUIRE(differences.size() == 6);
  const auto p = analysis::t_test_p(differences, 0.0, analysis::Sides::two);
  CHECK(report.primary->p.value() == Approx(p.value()).epsilon(1e-6));
  CHECK(report.primary->verdict == Verdict::supported);
  made.outcomes.state.closed = false;
  CHECK(own::make_report(made.outcomes).primary->verdict == Verdict::undecided);
}

TEST_CASE("thresholds are the same only if every difference is shown to lie within the margin") {
  HandMadeTracks alike = two_textures(kBark, kAlike);
  register_question(alike, equality(5.0));
  const own::ThresholdReport same = own::make_report(alike.outcomes);
  CHECK(same.primary->verdict == Verdict::supported);
  REQUIRE(same.primary->pairs.size() == 1);
  CHECK(same.primary->interval_level == Approx(0.9));
  CHECK(std::abs(same.primary->registered().interval->low) < 5.0);
  CHECK_THAT(same.primary->reason, names("90% 5.0"));
  register_question(alike, equality(0.1));
  CHECK(own::make_report(alike.outcomes).primary->verdict != Verdict::supported);
  HandMadeTracks others = two_textures(kBark, kSofter);
  register_question(others, equality(2.0));
  const own::ThresholdReport report = own::make_report(others.outcomes);
  CHECK(report.primary->verdict == Verdict::not_supported);
  CHECK_THAT(report.primary->reason, names("2.0"));
}

TEST_CASE("nothing follows from people who guess") {
  const std::vector<double> nowhere(6, 60.0);
  HandMadeTracks made = two_textures(nowhere, nowhere);
  register_question(made, equality(100.0));
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK(report.primary->verdict == Verdict::undecided);
  CHECK_FALSE(report.primary->reason.empty());
  register_question(made, kBarkAlone);
  CHECK(own::make_report(made.outcomes).primary->verdict == Verdict::undecided);
}

TEST_CASE("who misses more catch trials than registered is left out, which is no departure") {
  HandMadeTracks made = two_textures(kBark, kAlike);
  RegisteredAnalysis analysis = kBarkAlone;
  analysis.exclusion_rules = {.missed_catch = 2};
  register_question(made, analysis);
  made.outside(1, study::Role::catch_trial, 4, 2);
  made.outside(2, study::Role::catch_trial, 3, 3);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK(choice_of(report, "registered").participants == 5);
  CHECK(choice_of(report, "taken").participants == 6);
  CHECK_THAT(choice_of(report, "registered").words, names("1"));
  CHECK(report.departures.empty());
  exclude_late(made, 2);
  CHECK(own::make_report(made.outcomes).departures.empty());
  CHECK(choice_of(own::make_report(made.outcomes), "registered").participants == 5);
}

TEST_CASE("the verdict says by what everybody was left out") {
  HandMadeTracks made = two_textures(kBark, kAlike);
  RegisteredAnalysis analysis = kDifference;
  analysis.exclusion_rules = {.missed_catch = 2};
  register_question(made, analysis);
  for (int session = 1; session <= 6; ++session) {
    made.outside(session, study::Role::catch_trial, 3, 3);
  }
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK(choice_of(report, "registered").participants == 0);
  CHECK(report.primary->verdict == Verdict::undecided);
  CHECK_THAT(report.primary->reason, names("6 2"));
}

}  // namespace touchtrial
