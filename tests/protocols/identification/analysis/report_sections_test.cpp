#include "analysis/text_matching.hpp"
#include "protocols/design/random_orders.hpp"
#include "protocols/identification/analysis/hand_made_outcomes.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

constexpr int kBark = 0;
constexpr int kCloth = 1;

/// Right, wrong, without a response, right but not valid; then an excluded participant's right one.
HandMadeOutcomes five_trials() {
  HandMadeOutcomes made;
  made.session();
  made.session(false).row.excluded = true;
  made.trial({.felt = kBark, .answered = kBark, .answered_after_s = 1});
  made.trial({.felt = kCloth, .answered = kBark, .answered_after_s = 2});
  made.trial({.felt = kBark, .answered = std::nullopt});
  made.trial({.felt = kCloth, .answered = kCloth, .answered_after_s = 4, .within_limits = false});
  made.trial({.session = 2, .felt = kBark, .answered = kBark});
  return made;
}

using Groups = std::vector<std::pair<std::string, analysis::Proportion>>;

Groups groups_of(const analysis::Outcomes& outcomes, analysis::identification::BreakdownKind kind,
                 int method = 0) {
  Groups groups;
  for (const analysis::identification::Breakdown& one :
       analysis::identification::breakdowns(outcomes, method)) {
    if (one.kind != kind) continue;
    for (const analysis::identification::GroupAccuracy& group : one.groups) {
      CHECK(group.wilson == analysis::wilson_interval(group.accuracy));
      groups.emplace_back(group.group, group.accuracy);
    }
  }
  return groups;
}

/// Three participants; the first method always right, the second with bark alone, the third never.
analysis::identification::StudyReport three_methods() {
  HandMadeOutcomes made({"a", "b", "c"});
  for (int session = 1; session <= 3; ++session) {
    made.session();
    for (int method = 0; method < 3; ++method) {
      for (const int felt : {kBark, kCloth}) {
        const bool right = method == 0 || (method == 1 && felt == kBark);
        made.trial({.session = session,
                    .felt = felt,
                    .answered = right ? felt : 1 - felt,
                    .method = method});
      }
    }
  }
  return analysis::identification::make_report(made.outcomes);
}

}  // namespace

TEST_CASE("Accuracy is broken down by a trial's place and by what came before") {
  const analysis::Outcomes outcomes = five_trials().outcomes;
  CHECK(groups_of(outcomes, analysis::identification::BreakdownKind::trial) ==
        Groups{{"1", {1, 1}}, {"2", {1, 0}}, {"3", {1, 0}}, {"4", {1, 1}}});
  CHECK(groups_of(outcomes, analysis::identification::BreakdownKind::previous_stimulus) ==
        Groups{{"bark", {2, 1}}, {"cloth", {1, 0}}, {"first of its block", {1, 1}}});
  CHECK(groups_of(outcomes, analysis::identification::BreakdownKind::previous_response) ==
        Groups{{"bark", {2, 0}}, {"no response", {1, 1}}, {"first of its block", {1, 1}}});
  CHECK(groups_of(outcomes, analysis::identification::BreakdownKind::exemplar).empty());
  CHECK(groups_of(outcomes, analysis::identification::BreakdownKind::order_group).empty());
}

TEST_CASE("A catch trial and a lead-in come before, but have no accuracy") {
  HandMadeOutcomes made;
  made.session();
  made.trial({.felt = kCloth, .answered = kCloth, .kind = design::PresentationKind::lead_in});
  made.trial({.felt = kBark, .answered = kBark});
  made.trial({.answered = kBark, .kind = design::PresentationKind::catch_trial});
  made.trial({.felt = kCloth, .answered = kBark});
  CHECK(groups_of(made.outcomes, analysis::identification::BreakdownKind::previous_stimulus) ==
        Groups{{"cloth", {1, 1}}, {"no texture", {1, 0}}});
  CHECK(groups_of(made.outcomes, analysis::identification::BreakdownKind::trial) ==
        Groups{{"1", {1, 1}}, {"2", {1, 0}}});
}

TEST_CASE("Images of a class are groups where a class has several") {
  HandMadeOutcomes made = five_trials();
  made.outcomes.exemplars[kBark] = {"oak.png", "pine.png"};
  made.outcomes.trials[2].stimulus.exemplar = 1;
  CHECK(
      groups_of(made.outcomes, analysis::identification::BreakdownKind::exemplar) ==
      Groups{{"bark: oak.png", {1, 1}}, {"bark: pine.png", {1, 0}}, {"cloth: cloth.png", {2, 1}}});
}

TEST_CASE("Order groups are the orders in which methods came") {
  HandMadeOutcomes made({"a", "b"});
  for (int session = 1; session <= 3; ++session) {
    made.session();
    const int first = session == 2 ? 1 : 0;
    for (const int method : {first, 1 - first}) {
      made.trial({.session = session,
                  .felt = kBark,
                  .answered = session == 2 ? kCloth : kBark,
                  .method = method});
    }
  }
  CHECK(groups_of(made.outcomes, analysis::identification::BreakdownKind::order_group) ==
        Groups{{"a, then b", {2, 2}}, {"b, then a", {1, 0}}});
}

TEST_CASE("Reaction times are of answered trials, by class and all together") {
  const auto times = analysis::identification::reaction_times(five_trials().outcomes, 0);
  REQUIRE(times.size() == 3);
  CHECK(times[kBark].from_plane_on.n == 1);
  CHECK(times[kBark].from_plane_on.median == 1.0);
  CHECK(times[kCloth].from_plane_on.lower == 2.5);
  CHECK(times[kCloth].from_plane_on.median == 3.0);
  CHECK(times[kCloth].from_plane_on.upper == 3.5);
  CHECK(times[2].from_plane_on.lower == 1.5);
  CHECK(times[2].from_plane_on.median == 2.0);
  CHECK(times[2].from_plane_on.upper == 3.0);
  CHECK(times[2].from_contact.median == 1.5);
  CHECK(times[2].seconds == std::vector<double>{1.0, 2.0, 4.0});
}

TEST_CASE("Robustness leaves out and puts back what its subsets say") {
  const auto subsets = analysis::identification::robustness(five_trials().outcomes, 0);
  REQUIRE(subsets.size() == 4);
  CHECK(subsets[0].subset == analysis::identification::TrialSubset::counted);
  CHECK(subsets[0].pooled == analysis::Proportion{4, 2});
  CHECK(subsets[1].subset == analysis::identification::TrialSubset::answered);
  CHECK(subsets[1].pooled == analysis::Proportion{3, 2});
  CHECK(subsets[2].subset == analysis::identification::TrialSubset::valid);
  CHECK(subsets[2].pooled == analysis::Proportion{3, 1});
  CHECK(subsets[3].subset == analysis::identification::TrialSubset::with_excluded_sessions);
  CHECK(subsets[3].pooled == analysis::Proportion{5, 3});
  CHECK(subsets[3].mean.mean.value() == Approx(0.75));
}

TEST_CASE("An excluded participant who started again is not put back twice") {
  HandMadeOutcomes made = five_trials();
  made.outcomes.sessions[1].row.replaced_by = "P2";
  CHECK(analysis::identification::robustness(made.outcomes, 0)[3].pooled ==
        analysis::Proportion{4, 2});
}

TEST_CASE("With three methods, every pair is compared and adjusted, and all are compared at once") {
  const analysis::identification::StudyReport report = three_methods();
  CHECK_FALSE(report.comparison.has_value());
  REQUIRE(report.pairs.size() == 3);
  const double differences[] = {0.5, 1.0, 0.5};
  for (int i = 0; i < 3; ++i) {
    CHECK(report.pairs[i].overall.difference.value() == Approx(differences[i]));
    CHECK(report.pairs[i].overall.p == 0.25);  // two of eight sign patterns
    CHECK(report.pairs[i].p_holm == 0.75);
    CHECK_FALSE(report.pairs[i].mcnemar_mid_p.has_value());  // two pairs a participant
  }
  const analysis::identification::ClassComparison& bark = report.pairs[1].classes[kBark];
  CHECK(bark.first == analysis::Proportion{3, 3});
  CHECK(bark.second == analysis::Proportion{3, 0});
  CHECK(bark.mcnemar_mid_p.value() == Approx(0.125));  // 2 / 8 less half of that
  CHECK(report.pairs[0].classes[kBark].paired.difference.value() == Approx(0.0));
  REQUIRE(report.together.has_value());
  CHECK(report.together->cochran.q == Approx(9.0));
  CHECK(report.together->cochran.degrees_of_freedom == 2);
}

TEST_CASE("Three methods are shown in JSON and on the terminal") {
  const analysis::identification::StudyReport report = three_methods();
  const auto json = nlohmann::json::parse(analysis::identification::report_json(report));
  CHECK_FALSE(json.contains("comparison"));
  CHECK(json["pairs"][1]["first"] == "a");
  CHECK(json["pairs"][1]["second"] == "c");
  CHECK(json["pairs"][1]["p_holm"] == 0.75);
  CHECK(json["together"]["q"].get<double>() == Approx(9.0));
  for (const auto& key : json["pairs"][0]["references"]) {
    CHECK(json["references"].contains(key.get<std::string>()));
  }
  const std::string text =
      analysis::document_text(analysis::identification::study_document(report, {}));
  CHECK(contains(text, "a less c"));
  CHECK(contains(text, "Cochran's Q = 9.00 on 2 degrees of freedom"));
}

TEST_CASE("Numbers do not depend on the order in which trials are read") {
  HandMadeOutcomes made = five_trials();
  const auto figures = [&] {
    auto json = nlohmann::json::parse(analysis::identification::report_json(
        analysis::identification::make_report(made.outcomes)));
    // A mean over random deals, which depend on the order of trials.
    json["methods"][0]["information_transfer"].erase("null_mean");
    return json;
  };
  const auto before = figures();
  std::ranges::reverse(made.outcomes.trials);
  CHECK(before == figures());
}

}  // namespace touchtrial
