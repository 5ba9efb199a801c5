#include "analysis/choices/orders.hpp"
#include "analysis/text_matching.hpp"
#include "protocols/identification/analysis/hand_made_outcomes.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "study/random_orders.hpp"
#include "support/catch.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using namespace analysis::identification;
using namespace choices;

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

Groups groups_of(const analysis::Outcomes& outcomes, BreakdownKind kind, int method = 0) {
  Groups groups;
  for (const Breakdown& one : breakdowns(outcomes, method)) {
    if (one.kind != kind) continue;
    for (const GroupAccuracy& group : one.groups) {
      CHECK(group.wilson == analysis::wilson_interval(group.accuracy));
      groups.emplace_back(group.group, group.accuracy);
    }
  }
  return groups;
}

/// Three participants; the first method always right, the second with bark alone, the third never.
StudyReport three_methods() {
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
  return make_report(made.outcomes);
}

}  // namespace

TEST_CASE("Accuracy is broken down by a trial's place") {
  const analysis::Outcomes outcomes = five_trials().outcomes;
  CHECK(groups_of(outcomes, BreakdownKind::trial) ==
        Groups{{"1", {1, 1}}, {"2", {1, 0}}, {"3", {1, 0}}, {"4", {1, 1}}});
  CHECK(groups_of(outcomes, BreakdownKind::exemplar).empty());
  CHECK(groups_of(outcomes, BreakdownKind::order_group).empty());
}

TEST_CASE("A catch trial and a lead-in come before, but have no accuracy") {
  HandMadeOutcomes made;
  made.session();
  made.trial({.felt = kCloth, .answered = kCloth, .role = study::Role::lead_in});
  made.trial({.felt = kBark, .answered = kBark});
  made.trial({.answered = kBark, .role = study::Role::catch_trial});
  made.trial({.felt = kCloth, .answered = kBark});
  made.trial({.felt = kCloth, .answered = kBark});
  // The last of four trials alone is wrong after a texture, and after an answer: it names neither
  // cloth nor anything but that answer, bark.
  const auto order = order_effects_of(made.outcomes, 0);
  REQUIRE(order.has_value());
  CHECK(order->class_before.wrong == 1);
  CHECK(order->class_before.same == 0);
  CHECK(order->answer_before.wrong == 1);
  CHECK(order->answer_before.same == 1);
  CHECK(order->draws == 1999);
  CHECK(groups_of(made.outcomes, BreakdownKind::trial) ==
        Groups{{"1", {1, 1}}, {"2", {1, 0}}, {"3", {1, 0}}});
}

TEST_CASE("Unbiased hit rates are of participants, and their mean of classes comes last") {
  HandMadeOutcomes made;
  for (int session = 1; session <= 2; ++session) {
    made.session();
    made.trial({.session = session, .felt = kBark, .answered = kBark});
    made.trial({.session = session, .felt = kCloth, .answered = session == 1 ? kCloth : kBark});
  }
  const auto report = make_report(made.outcomes);
  const auto& unbiased = report.methods[0].unbiased_hits;
  REQUIRE(unbiased.size() == 3);
  CHECK(unbiased[kBark].rate.mean == 0.75);  // 1, and 1 of 1 presented times 1 of 2 answered
  CHECK(unbiased[kCloth].rate.mean == 0.5);
  CHECK(unbiased[2].rate.mean == 0.625);
  CHECK(unbiased[kBark].chance_rate == 0.5);  // always right or wrong together; and always 1/2
  const auto json = nlohmann::json::parse(report_json(report));
  CHECK(json["methods"][0]["unbiased_hits"]["mean"] == 0.625);
  CHECK(json["methods"][0]["unbiased_hits"]["classes"][kCloth]["mean"] == 0.5);
}

TEST_CASE("Confidence is reported by rating and as type-2 areas, if the study asks for it") {
  HandMadeOutcomes made;
  made.session();
  made.session();
  const auto rated = [&](int session, int answered, int confidence) {
    made.trial({.session = session, .felt = kBark, .answered = answered});
    made.outcomes.trials.back().row.confidence = confidence;
  };
  rated(1, kBark, 3);
  rated(1, kCloth, 1);
  rated(1, kBark, 1);
  rated(2, kBark, 3);
  CHECK_FALSE(confidence_of(made.outcomes, 0).has_value());
  made.outcomes.design.session.confidence_levels = 3;
  const auto report = make_report(made.outcomes);
  const auto& confidence = report.methods[0].confidence;
  REQUIRE(confidence.has_value());
  REQUIRE(confidence->ratings.size() == 3);
  CHECK(confidence->ratings[0].accuracy == analysis::Proportion{2, 1});
  CHECK(confidence->ratings[0].mean.participants == 1);
  CHECK(confidence->ratings[1].accuracy.n == 0);
  CHECK(confidence->ratings[2].mean.participants == 2);
  CHECK(confidence->area.participants == 1);
  CHECK(confidence->area.mean == 0.75);
  CHECK(confidence->without_area == 1);
  const auto json = nlohmann::json::parse(report_json(report));
  CHECK(json["methods"][0]["confidence"]["type_2_area"]["mean"] == 0.75);
  CHECK(json["methods"][0]["confidence"]["ratings"][2]["rating"] == 3);
}

TEST_CASE("Stations are strata of the deciding question in a collected study") {
  HandMadeOutcomes made;
  made.outcomes.design.classes.resize(2);
  const int right_of[] = {1, 2, 3, 4};  // of four trials
  for (int session = 1; session <= 4; ++session) {
    made.session().row.station = session <= 2 ? 1 : 2;
    for (int i = 0; i < 4; ++i) {
      made.trial({.session = session,
                  .felt = kBark,
                  .answered = i < right_of[session - 1] ? kBark : kCloth});
    }
  }
  const auto report = make_report(made.outcomes);
  REQUIRE(report.primary.has_value());
  REQUIRE(report.primary->stations.has_value());
  CHECK(report.primary->stations->strata == 2);
  CHECK(report.primary->stations->mean == 0.625);
  // Narrower than over participants, because the stations differ.
  CHECK(report.primary->stations->interval->low > report.primary->registered().interval->low);
  CHECK_FALSE(report.primary->stations->random.has_value());
  const auto json = nlohmann::json::parse(report_json(report));
  CHECK(json["primary"]["stations"]["stations"] == 2);
  CHECK(json["primary"]["stations"]["random"].is_null());
  CHECK(contains(analysis::document_markdown(analysis::tables_only(study_document(report, {})), ""),
                 "2 stations"));
  for (analysis::SessionOutcome& one : made.outcomes.sessions) one.row.station = 0;
  CHECK_FALSE(make_report(made.outcomes).primary->stations.has_value());
}

TEST_CASE("Images of a class are groups where a class has several") {
  HandMadeOutcomes made = five_trials();
  made.outcomes.exemplars[kBark] = {"oak.png", "pine.png"};
  made.outcomes.trials[2].stimulus.exemplar = 1;
  CHECK(groups_of(made.outcomes, BreakdownKind::exemplar) == Groups{{"bark: oak.png", {1, 1}},
                                                                    {"bark: pine.png", {1, 0}},
                                                                    {"cloth: cloth.png", {2, 1}}});
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
  CHECK(groups_of(made.outcomes, BreakdownKind::order_group) ==
        Groups{{"a, then b", {2, 2}}, {"b, then a", {1, 0}}});
}

TEST_CASE("Reaction times are of answered trials, by class and all together") {
  const auto times = reaction_times(five_trials().outcomes, 0);
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
  const auto subsets = robustness(five_trials().outcomes, 0);
  REQUIRE(subsets.size() == 4);
  CHECK(subsets[0].subset == TrialSubset::counted);
  CHECK(subsets[0].pooled == analysis::Proportion{4, 2});
  CHECK(subsets[1].subset == TrialSubset::answered);
  CHECK(subsets[1].pooled == analysis::Proportion{3, 2});
  CHECK(subsets[2].subset == TrialSubset::valid);
  CHECK(subsets[2].pooled == analysis::Proportion{3, 1});
  CHECK(subsets[3].subset == TrialSubset::with_excluded_sessions);
  CHECK(subsets[3].pooled == analysis::Proportion{5, 3});
  CHECK(subsets[3].mean.mean.value() == Approx(0.75));
}

TEST_CASE("An excluded participant who started again is not put back twice") {
  HandMadeOutcomes made = five_trials();
  made.outcomes.sessions[1].row.replaced_by = "P2";
  CHECK(robustness(made.outcomes, 0)[3].pooled == analysis::Proportion{4, 2});
}

TEST_CASE("With three methods, every pair is compared and adjusted, and all are compared at once") {
  const StudyReport report = three_methods();
  CHECK_FALSE(report.comparison.has_value());
  REQUIRE(report.pairs.size() == 3);
  const double differences[] = {0.5, 1.0, 0.5};
  for (int i = 0; i < 3; ++i) {
    CHECK(report.pairs[i].overall.difference.value() == Approx(differences[i]));
    CHECK(report.pairs[i].overall.p == 0.25);  // two of eight sign patterns
    CHECK(report.pairs[i].p_holm == 0.75);
    CHECK_FALSE(report.pairs[i].mcnemar_mid_p.has_value());  // two pairs a participant
  }
  const ClassComparison& bark = report.pairs[1].classes[kBark];
  CHECK(bark.first == analysis::Proportion{3, 3});
  CHECK(bark.second == analysis::Proportion{3, 0});
  CHECK(bark.mcnemar_mid_p.value() == Approx(0.125));  // 2 / 8 less half of that
  CHECK(report.pairs[0].classes[kBark].comparison.difference.value() == Approx(0.0));
  REQUIRE(report.all_methods.has_value());
  CHECK(report.all_methods->cochran.q == Approx(9.0));
  CHECK(report.all_methods->cochran.degrees_of_freedom == 2);
}

TEST_CASE("Three methods are shown in JSON and on the terminal") {
  const StudyReport report = three_methods();
  const auto json = nlohmann::json::parse(report_json(report));
  CHECK_FALSE(json.contains("comparison"));
  CHECK(json["pairs"][1]["first"] == "a");
  CHECK(json["pairs"][1]["second"] == "c");
  CHECK(json["pairs"][1]["p_holm"] == 0.75);
  CHECK(json["together"]["q"].get<double>() == Approx(9.0));
  for (const auto& key : json["pairs"][0]["references"]) {
    CHECK(json["references"].contains(key.get<std::string>()));
  }
  const std::string text = analysis::document_text(study_document(report, {}));
  CHECK(contains(text, "a minus c"));
  CHECK(contains(text, "Q = 9.00"));
}

TEST_CASE("Numbers do not depend on the order in which trials are read") {
  HandMadeOutcomes made = five_trials();
  const auto figures = [&] {
    auto json = nlohmann::json::parse(report_json(make_report(made.outcomes)));
    // A mean over random deals, which depend on the order of trials.
    json["methods"][0]["information_transfer"].erase("null_mean");
    return json;
  };
  const auto before = figures();
  std::ranges::reverse(made.outcomes.trials);
  CHECK(before == figures());
}

}  // namespace touchtrial
