#include "protocols/threshold/analysis/hand_made_tracks.hpp"
#include "protocols/threshold/analysis/report.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace own = analysis::threshold;

}  // namespace

TEST_CASE("catch trials are counted by participant, and poor ones are warned of") {
  HandMadeTracks made = tracks_of(detection_options(), 1, {-20.0, -20.0});
  made.caught(1, 1, 4, 0);
  made.caught(2, 1, 2, 2);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.catches);
  CHECK(report.catches->pooled.answers == analysis::Proportion{8, 6});
  REQUIRE(report.attention.size() == 2);
  CHECK_FALSE(report.attention[0].is_doubtful());
  CHECK(report.attention[1].p_holm == Approx(2 * 0.01401875));
  CHECK(report.attention[1].is_doubtful());
  const auto json = json_of(made);
  CHECK(json.at("catch").at("attentive") == 0.95);
  CHECK(json.at("catch").at("participants").at(1).at("attending").at("doubtful") == true);
  CHECK_THAT(json.at("warnings").dump(), names("P2 2 4"));
}

TEST_CASE("nobody who attends but for one slip is said not to") {
  HandMadeTracks made = tracks_of(detection_options(), 1, std::vector<double>(12, -20.0));
  for (int person = 1; person <= 12; ++person)
    made.caught(person, 1, person % 2 == 0 ? 3 : 4, person % 2 == 0 ? 1 : 0);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK(std::none_of(report.attention.begin(), report.attention.end(),
                     [](const choices::Attention& one) { return one.is_doubtful(); }));
  const std::string warnings = json_of(made).at("warnings").dump();
  CHECK_THAT(warnings, !holds_text("inattention"));
}

TEST_CASE("preferences for different intervals are named, with what they do to right answers") {
  HandMadeTracks made(detection_options());
  for (int person = 1; person <= 8; ++person) {
    made.session();
    const int preferred = person % 2;  // odd: the second interval
    for (int i = 0; i < 60; ++i) {
      const int target = i % 2;
      const bool right = i % 5 != 0 || person > 4 ? i % 5 != 0 : target == preferred;
      made.answer({person, 1, 20, target, right ? target : 1 - target});
    }
  }
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK(report.choice_use[0].excess.p.value() > 0.5);
  REQUIRE(report.preferences.people.size() == 8);
  CHECK(report.preferences.people[0].choice == 1);
  CHECK(report.preferences.people[1].choice == 0);
  CHECK(report.preferences.people[0].right_there == analysis::Proportion{30, 30});
  CHECK(report.preferences.people[0].right_elsewhere == analysis::Proportion{30, 24});
  const auto json = json_of(made);
  const auto& preferences = json.at("preferences");
  CHECK(preferences.at("participants").at(0).at("preferred") == "second");
  CHECK(preferences.at("anybody").at("found") == report.preferences.global_null.found());
}

TEST_CASE("a preferred interval is its share named less its share of targets") {
  HandMadeTracks made(detection_options());
  for (int person = 1; person <= 3; ++person) {
    made.session();
    for (int i = 0; i < 10; ++i) made.answer({person, 1, 20, i % 2, i < 7 + person ? 0 : 1});
  }
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.choice_use.size() == 2);
  CHECK(report.choice_use[0].named_count == 8 + 9 + 10);
  CHECK(report.choice_use[0].target_count == 15);
  CHECK(report.choice_use[0].excess.mean.mean.value() == Approx(0.4));
  CHECK(report.choice_use[1].excess.mean.mean.value() == Approx(-0.4));
  // t = 0.4 / (0.1 / sqrt 3) = 6.928 with two degrees of freedom.
  CHECK(report.choice_use[0].excess.p.value() == Approx(0.0202).margin(1e-4));
}

TEST_CASE("repeated answers are counted after right and after wrong ones, within sessions") {
  HandMadeTracks made(detection_options());
  made.session();
  // Answers 0 0 1 1 0; the first and the fourth are right.
  const int answers[] = {0, 0, 1, 1, 0};
  const int targets[] = {0, 1, 0, 1, 1};
  for (int i = 0; i < 5; ++i) made.answer({1, 1, 20, targets[i], answers[i]});
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK(report.after_right.repeats == analysis::Proportion{2, 1});
  CHECK(report.after_wrong.repeats == analysis::Proportion{2, 1});
  // After right: once 0, of which two of the other four are, and once 1, of which one is.
  CHECK(report.after_right.expected.value() == Approx((2.0 / 4.0 + 1.0 / 4.0) / 2.0));
  CHECK_FALSE(report.after_right.excess.p);
}

TEST_CASE("d' of same or different takes hits of a level and false alarms of all levels") {
  HandMadeTracks made(same_different_options(), {"bark", "cloth"});
  made.session();
  const auto add = [&](int level, int target, int different, int n) {
    for (int i = 0; i < n; ++i) made.answer({1, 1, level, target, i < different ? 1 : 0});
  };
  for (int level = 0; level < 3; ++level) add(level, 0, level, 10);  // 3 false alarms of 30
  add(0, 1, 1, 10);
  add(1, 1, 5, 10);
  add(2, 1, 10, 10);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK_FALSE(report.has_thresholds());
  REQUIRE(report.same_different.size() == 6);
  const own::SameDifferentLevel& middle = report.same_different[1];
  CHECK(middle.participant == "P1");
  CHECK(middle.different == analysis::Proportion{10, 5});
  CHECK(middle.same == analysis::Proportion{10, 1});
  CHECK(middle.same_at_all_levels == analysis::Proportion{30, 3});
  CHECK(*middle.d_differencing ==
        Approx(analysis::differencing_d_prime({0.5, 0.1})->d_prime).epsilon(1e-12));
  CHECK(*middle.d_independent ==
        Approx(analysis::independent_d_prime({0.5, 0.1})->d_prime).epsilon(1e-12));
  CHECK(*report.same_different[0].d_differencing == Approx(0.0).margin(1e-9));
  CHECK(*report.same_different[2].d_differencing ==
        Approx(analysis::differencing_d_prime({0.95, 0.1})->d_prime).epsilon(1e-12));
  CHECK(report.same_different[3].participant.empty());
  const auto json = json_of(made);
  CHECK(json.at("criterion").is_null());
  CHECK(json.at("tracks").at(0).at("estimate").is_null());
  CHECK(json.at("same_different").at("levels").size() == 6);
  const auto& group = json.at("same_different").at("groups").at(1);
  CHECK(group.at("participants") == 1);
  CHECK(group.at("differencing").at("d_prime") == Approx(*middle.d_differencing));
  CHECK(group.at("differencing").at("interval").is_null());
}

TEST_CASE("d' of a group is that of all answers pooled, with an interval over people") {
  HandMadeTracks made(same_different_options(), {"bark", "cloth"});
  int hits = 0;
  for (int person = 0; person < 8; ++person) {
    made.session();
    const int own = 4 + person % 4;
    for (int i = 0; i < 10; ++i) {
      made.answer({person + 1, 1, 1, 0, i < 2 ? 1 : 0});
      made.answer({person + 1, 1, 1, 1, i < own ? 1 : 0});
    }
    hits += own;
  }
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.same_different_groups.size() == 1);
  const own::SameDifferentGroup& group = report.same_different_groups[0];
  CHECK(group.participants == 8);
  const double pooled = analysis::differencing_d_prime({hits / 80.0, 0.2})->d_prime;
  CHECK(*group.differencing.d_prime == Approx(pooled).epsilon(1e-12));
  CHECK(group.differencing.interval->low < pooled);
  CHECK(group.differencing.interval->high > pooled);
  CHECK(*group.independent.d_prime < pooled);
}

}  // namespace touchtrial
