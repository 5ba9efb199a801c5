#include "analysis/report/results.hpp"
#include "protocols/threshold/analysis/hand_made_tracks.hpp"
#include "protocols/threshold/analysis/report.hpp"
#include "protocols/threshold/analysis/threshold_analysis.hpp"
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
using procedures::Censored;
using procedures::Shape;
using study::Role;

void check_holds(const procedures::Threshold& threshold, double truth) {
  REQUIRE(threshold.censored == Censored::no);
  CHECK(threshold.low.value_or(-1e9) < truth);
  CHECK(threshold.high.value_or(1e9) > truth);
  CHECK(threshold.level.value() == Approx(truth).margin(4.0));
}

}  // namespace

TEST_CASE("the intervals of an adaptive track hold the known threshold") {
  const own::ThresholdReport report =
      own::make_report(tracks_of(detection_options(), 1, {-25.0, -15.0}, true).outcomes);
  REQUIRE(report.tracks.size() == 2);
  CHECK(report.criterion.value() == Approx(1.0 - 0.5 * std::exp(-1.0)));
  check_holds(report.tracks[0].estimate->threshold, -25.0);
  check_holds(report.tracks[1].estimate->threshold, -15.0);
  CHECK(report.tracks[0].answers.n == 60);
  CHECK(report.tracks[0].estimate->observer.slope > 1.0);
  CHECK_FALSE(report.tracks[0].reversals);
  CHECK_FALSE(report.tracks[0].fit);
  const own::StandardReport& bark = report.standards.at(0);
  CHECK(bark.words == "bark");
  CHECK(bark.mean.mean.value() ==
        Approx(0.5 * (*report.tracks[0].threshold() + *report.tracks[1].threshold())));
  CHECK(bark.mean.sd.value() ==
        Approx(std::abs(*report.tracks[0].threshold() - *report.tracks[1].threshold()) /
               std::sqrt(2.0)));
}

TEST_CASE("constant stimuli have the same estimate, and say how well the function fits") {
  const own::ThresholdReport report =
      own::make_report(tracks_of(constant_options({-12.0}), 1, {-14.0, -16.0, -15.0}).outcomes);
  for (const own::TrackReport& track : report.tracks) {
    REQUIRE(track.fit);
    CHECK(track.fit->p > 0.001);
    CHECK(track.estimate->observer.threshold == Approx(*track.threshold()).margin(1e-6));
  }
  const double mean = report.standards.at(0).mean.mean.value();
  const auto json = json_of(tracks_of(constant_options({-12.0}), 1, {-14.0, -16.0, -15.0}));
  CHECK(json.at("tracks").at(0).at("estimate").at("threshold") ==
        Approx(*report.tracks[0].threshold()));
  CHECK(json.at("standards").at(0).at("mean") == Approx(mean));
  CHECK(json.at("standards").at(0).at("weber").at("fraction") ==
        Approx(std::pow(10.0, mean / 20.0)));
  CHECK(json.at("standards").at(0).at("value") == -12.0);
}

TEST_CASE("a staircase also has the mean of its reversals") {
  study::threshold::ThresholdOptions options = detection_options();
  options.track.procedure = "up-down";
  const own::ThresholdReport report = own::make_report(tracks_of(options, 1, {-20.0}).outcomes);
  REQUIRE(report.tracks.at(0).reversals);
  CHECK(report.tracks[0].reversals->level.value() == Approx(-21.0).margin(4.0));
  const std::string text =
      analysis::document_text(own::threshold_analysis()
                                  .results(tracks_of(options, 1, {-20.0}).outcomes, {})
                                  ->document({}, {}));
  CHECK_THAT(text, holds_text("70.7%") && holds_text("81.6%"));
}

TEST_CASE("a censored track has no number, and no mean of people leaves it out") {
  const auto json = json_of(tracks_of(detection_options(), 1, {-20.0, 30.0, -90.0}, true));
  const auto& above = json.at("tracks").at(1);
  CHECK(above.at("estimate").at("censored") != "below");
  CHECK(json.at("tracks").at(2).at("estimate").at("censored") != "above");
  CHECK(json.at("tracks").at(2).at("estimate").at("threshold").is_null());
  CHECK(above.at("estimate").at("threshold").is_null());
  CHECK(above.at("estimate").at("high").is_null());
  // By-products, which no track has as results.
  CHECK_FALSE(above.at("estimate").contains("slope"));
  CHECK_FALSE(above.at("estimate").contains("lapse"));
  CHECK(above.at("weber").is_null());
  CHECK(above.at("learning_db").is_null());
  const auto& bark = json.at("standards").at(0);
  CHECK(bark.at("n") == 3);
  CHECK(bark.at("tracks") == 3);
  CHECK(bark.at("known") == 1);
  const auto tracks_that_are = [&](const char* censored) {
    return std::ranges::count_if(json.at("tracks"), [&](const auto& track) {
      return track.at("estimate").at("censored") == censored;
    });
  };
  CHECK(bark.at("above") == tracks_that_are("above"));
  CHECK(bark.at("below") == tracks_that_are("below"));
  CHECK(bark.at("undetermined") == tracks_that_are("undetermined"));
  CHECK(bark.at("interval").is_null());
  CHECK(bark.at("mean").is_null());
  CHECK(bark.at("lack") == "most censored");
  CHECK(bark.at("median") == json.at("tracks").at(0).at("in_mean").at(0));
  CHECK(above.at("in_mean") == nlohmann::json::parse("[0.0, null]"));
  CHECK_THAT(json.at("warnings").dump(), names("bark 3 1"));
}

TEST_CASE("one trial of each person, or one level, tells neither a side nor a median") {
  const bool one_level = GENERATE(false, true);
  study::threshold::ThresholdOptions options = detection_options();
  if (one_level) {
    options.track.procedure = "constant-stimuli";
    options.track.levels = {-10.0};
  }
  HandMadeTracks made(options);
  for (int person = 1; person <= 4; ++person) {
    made.session();
    // 16 or 17 of 20 right: the share at the threshold.
    for (int i = 0; i < (one_level ? 20 : 1); ++i) {
      const bool right = one_level ? i < 16 + person % 2 : person != 4;
      made.answer({person, 1, one_level ? 0 : 22, i % 2, right ? i % 2 : 1 - i % 2});
    }
  }
  const auto json = json_of(made);
  for (const auto& track : json.at("tracks")) {
    CHECK(track.at("estimate").at("censored") == "undetermined");
  }
  const auto& bark = json.at("standards").at(0);
  CHECK(bark.at("known") == 0);
  CHECK(bark.at("below") == 0);
  CHECK(bark.at("above") == 0);
  CHECK(bark.at("undetermined") == 4);
  CHECK(bark.at("mean").is_null());
  CHECK(bark.at("median").is_null());
  CHECK(bark.at("median_within") == nlohmann::json::parse("[null, null]"));
  CHECK(bark.at("lack") == "most censored");
  CHECK_NOTHROW(analysis::document_text(
      own::threshold_analysis().results(made.outcomes, {})->document({}, {})));
}

TEST_CASE(
    "a track's estimate has its catch trials among its counts, and its trials alone elsewhere") {
  study::threshold::ThresholdOptions options = constant_options({-12.0, -6.0});
  HandMadeTracks made = tracks_of(options, 2, {-16.0});
  const own::ThresholdReport without = own::make_report(made.outcomes);
  made.caught(1, 2, 5, 1);
  const own::ThresholdReport with = own::make_report(made.outcomes);
  const own::TrackReport& first = with.tracks.at(0);
  const own::TrackReport& second = with.tracks.at(1);
  CHECK(first.catches == analysis::Proportion{});
  CHECK(second.catches == analysis::Proportion{6, 5});
  CHECK(second.answers == without.tracks.at(1).answers);
  CHECK(second.trials.size() == 140);
  CHECK(first.threshold() == without.tracks.at(0).threshold());
  const std::vector<double>& levels = with.standards.at(1).levels;
  std::vector<procedures::LevelCounts> counts = procedures::counts_of(levels, second.trials);
  REQUIRE(counts.back().level == levels.back());
  counts.back().n += 6;
  counts.back().correct += 5;
  const auto direct = procedures::estimate_threshold(counts, levels, Shape::weibull, 0.5);
  CHECK(second.threshold() == direct.threshold.level);
  CHECK(second.estimate->observer.lapse == direct.observer.lapse);
  CHECK(second.estimate->observer.lapse > without.tracks.at(1).estimate->observer.lapse);
  const auto json = json_of(made).at("tracks").at(1);
  CHECK(json.at("catch") == nlohmann::json{{"n", 6}, {"right", 5}});
  CHECK(json.at("trials") == 140);
}

TEST_CASE("too few trials at the highest level are warned of") {
  study::threshold::ThresholdOptions options = detection_options();
  const auto warnings = [&options] {
    return json_of(tracks_of(options, 1, {-20.0})).at("warnings").dump();
  };
  const std::string before = warnings();
  options.catch_trials = 6;
  CHECK(warnings().size() < before.size());
}

TEST_CASE("a participant who becomes better has a threshold that falls") {
  // In the first half levels from the fifth on are felt, then from the third on.
  const auto learning = [](bool backwards) {
    HandMadeTracks made(constant_options({-12.0}));
    made.session();
    for (int n = 0; n < 140; ++n) {
      const int i = backwards ? 139 - n : n;
      const bool felt = i % 7 >= (i < 70 ? 4 : 2);
      made.answer({1, 1, i % 7, 0, felt || i / 7 % 2 == 0 ? 0 : 1});
    }
    return own::make_report(made.outcomes);
  };
  const own::ThresholdReport better = learning(false);
  CHECK(better.tracks.at(0).learning_db.value() < -5.0);
  CHECK(learning(true).tracks.at(0).learning_db.value() ==
        Approx(-*better.tracks[0].learning_db).epsilon(1e-6));
  CHECK(better.learning_db.mean.mean == better.tracks[0].learning_db);
}

TEST_CASE("an adaptive track of an observer who does not change looks like no learning") {
  for (const char* procedure : {"quest-plus", "up-down"}) {
    study::threshold::ThresholdOptions options = detection_options();
    options.track.procedure = procedure;
    const own::ThresholdReport report =
        own::make_report(tracks_of(options, 1, std::vector<double>(30, -20.0), true).outcomes);
    INFO(procedure);
    CHECK(report.learning_db.mean.participants > 25);
    CHECK(*report.learning_db.p > 0.01);
  }
}

TEST_CASE("trials without an answer belong to no track") {
  HandMadeTracks made = tracks_of(detection_options(), 1, {-20.0});
  const int n = own::make_report(made.outcomes).tracks.at(0).answers.n;
  made.missed(1, 1, 40);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  CHECK(report.tracks.at(0).answers.n == n);
  CHECK(report.without_answer == 1);
}

TEST_CASE("sessions that do not count are left out of everything") {
  HandMadeTracks made(detection_options());
  made.session(false);
  made.answer({1, 1, 20, 0, 0});
  made.outside(1, Role::control, 3, 3);
  made.caught(1, 1, 3, 3);
  const auto json = json_of(made);
  CHECK(json.at("tracks").empty());
  CHECK(json.at("control").is_null());
  CHECK(json.at("catch").is_null());
  CHECK(json.at("standards").at(0).at("n") == 0);
}

TEST_CASE("a study without trials, and tracks of one or two trials, have a report") {
  for (int trials = 0; trials < 4; ++trials) {
    for (const auto& options : {detection_options(), constant_options({-12.0, -6.0})}) {
      HandMadeTracks made(options);
      if (trials > 0) made.session();
      for (int i = 0; i < trials; ++i) made.answer({1, 1, 3 + i / 2, i % 2, 0});
      const auto results = own::threshold_analysis().results(made.outcomes, {});
      CHECK_NOTHROW(analysis::document_text(results->document({}, {})));
      const auto json = nlohmann::json::parse(results->json());
      CHECK(json.at("tracks").size() == (trials > 0 ? 1 : 0));
      CHECK(json.at("levels").size() == options.track.levels.size());
    }
  }
  HandMadeTracks same(same_different_options(), {"bark", "cloth"});
  same.session();
  same.answer({1, 1, 0, 1, 1});
  const auto levels = json_of(same).at("same_different").at("levels");
  CHECK(levels.at(0).at("d_prime_differencing").is_null());
}

TEST_CASE("the task, the criterion and the units are in the report") {
  const auto json = json_of(HandMadeTracks(detection_options()));
  CHECK(json.at("task") == "detection");
  CHECK(json.at("question") == "which-interval");
  CHECK(json.at("along") == "gain");
  CHECK(json.at("unit") == "dB re the pack's gain");
  CHECK(json.at("protocol") == "threshold");
}

}  // namespace touchtrial
