#include "analysis/report/results.hpp"
#include "protocols/threshold/analysis/hand_made_tracks.hpp"
#include "protocols/threshold/analysis/report.hpp"
#include "protocols/threshold/analysis/threshold_analysis.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace own = analysis::threshold;
using procedures::Censored;
using procedures::Observer;
using procedures::Shape;
using study::Role;

Observer observer_at(double threshold) {
  return {Shape::weibull, threshold, 3.5, 0.5, 0.01};
}

/// Participants with these thresholds, each with every track of the study.
HandMadeTracks tracks_of(const study::threshold::ThresholdOptions& options, int tracks,
                         const std::vector<double>& thresholds, bool with_catches = false) {
  HandMadeTracks made(options);
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    made.session();
    for (int track = 1; track <= tracks; ++track) {
      RandomStream random(8, "threshold report test", 10 * i + static_cast<std::size_t>(track));
      const int session = static_cast<int>(i) + 1;
      if (with_catches) {
        made.attended_track(session, track, observer_at(thresholds[i]), random);
      } else {
        made.track(session, track, observer_at(thresholds[i]), random);
      }
    }
  }
  return made;
}

nlohmann::json json_of(const HandMadeTracks& made) {
  return nlohmann::json::parse(
      analysis::threshold::threshold_analysis().results(made.outcomes, {})->json());
}

bool has_table(const analysis::Document& page, const std::string& section, const std::string& id) {
  for (const analysis::Section& one : page.sections) {
    for (const analysis::Block* block : all_blocks(one)) {
      const auto* table = std::get_if<analysis::Table>(block);
      if (one.id == section && table != nullptr && table->id == id) return true;
    }
  }
  return false;
}

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

TEST_CASE("the mean of thresholds counts people beyond the levels on their side") {
  const HandMadeTracks made =
      tracks_of(detection_options(), 1, {-12.0, -9.0, -15.0, -6.0, 30.0, 40.0}, true);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  const own::StandardReport& bark = report.standards.at(0);
  REQUIRE(bark.mean.exact == 4);
  std::vector<analysis::Bounds> people;
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    people.push_back({*report.tracks[i].threshold(), *report.tracks[i].threshold()});
    sum += people.back().low;
  }
  people.resize(6, {0.0, std::numeric_limits<double>::infinity()});
  const analysis::CensoredMean expected = analysis::censored_mean(people);
  CHECK(bark.mean.mean == expected.mean);
  CHECK(bark.mean.interval == expected.interval);
  CHECK(*bark.mean.mean > sum / 4.0 + 1.0);
  const std::string text = analysis::document_text(
      own::threshold_analysis().results(made.outcomes, {})->document({}, {}));
  CHECK_THAT(text, names("6"));
  CHECK_THAT(text, names("2"));
}

TEST_CASE("if every track is censored there is no threshold, and no comparison fails") {
  study::threshold::ThresholdOptions options = detection_options();
  options.tracks_each = 2;
  const HandMadeTracks made = tracks_of(options, 2, {40.0, 40.0});
  const auto json = json_of(made);
  CHECK(json.at("standards").at(0).at("mean").is_null());
  CHECK(json.at("standards").at(0).at("n") == 2);
  // A participant of whom one track is undetermined is undetermined.
  CHECK(json.at("standards").at(0).at("above") == 1);
  CHECK(json.at("standards").at(0).at("undetermined") == 1);
  CHECK(json.at("standards").at(0).at("median_within") == nlohmann::json::parse("[0.0, null]"));
  CHECK_NOTHROW(analysis::document_text(
      own::threshold_analysis().results(made.outcomes, {})->document({}, {})));
}

TEST_CASE("differences of standards are paired and adjusted by Holm") {
  HandMadeTracks made(constant_options({-18.0, -12.0, -6.0}));
  for (int person = 1; person <= 5; ++person) {
    made.session();
    for (int track = 1; track <= 3; ++track) {
      RandomStream random(3, "differences", static_cast<std::uint64_t>(10 * person + track));
      made.track(person, track, observer_at(-20.0 + 4.0 * track), random);
    }
  }
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.differences.size() == 3);
  const own::DifferenceReport& first = report.differences[0];
  CHECK(first.difference.mean.value() ==
        Approx(*report.standards[0].mean.mean - *report.standards[1].mean.mean));
  std::vector<double> p;
  for (const auto& one : report.differences) p.push_back(*one.p);
  const double least = *std::min_element(p.begin(), p.end());
  for (const auto& one : report.differences) {
    CHECK(*one.p_holm >= *one.p);
    if (*one.p == least) CHECK(*one.p_holm == Approx(std::min(1.0, 3.0 * least)));
  }
  CHECK(report.standards[2].words == "bark, standard -6 dB");
}

TEST_CASE("a difference from a threshold beyond the levels is a bound, and people count in it") {
  HandMadeTracks made(constant_options({-18.0, -12.0}));
  for (int person = 1; person <= 5; ++person) {
    made.session();
    for (int track = 1; track <= 2; ++track) {
      RandomStream random(4, "bounds", static_cast<std::uint64_t>(10 * person + track));
      const bool feels_nothing = person == 5 && track == 2;
      made.track(person, track, observer_at(feels_nothing ? 60.0 : -20.0 + person), random);
    }
  }
  const own::ThresholdReport report = own::make_report(made.outcomes);
  const own::DifferenceReport& one = report.differences.at(0);
  CHECK(one.difference.participants == 5);
  CHECK(one.difference.exact == 4);
  CHECK(one.known == 4);
  CHECK(report.standards[1].number_of(Censored::no) == 4);
  CHECK(report.standards[1].number_of(Censored::below) == 0);
  CHECK(one.difference.mean.has_value());
  CHECK(one.p.has_value());
}

TEST_CASE("a person's threshold is the mean of tracks, and of bounds where one is beyond") {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  const std::vector<double> levels = {-40.0, -20.0, 0.0};
  const auto track = [](procedures::Threshold threshold, double median) {
    return procedures::ThresholdEstimate{threshold, observer_at(median), threshold};
  };
  const auto inside = track({-10.0, -12.0, -8.0}, -10.0);
  const auto other = track({-14.0, -16.0, -12.0}, -14.0);
  const auto above = track({{}, 0.0, {}, Censored::above}, 9.0);
  const auto below = track({{}, {}, -40.0, Censored::below}, -47.0);
  const auto near_end = track({{}, -5.0, {}, Censored::undetermined}, -1.5);
  const auto just_beyond = track({{}, -5.0, {}, Censored::undetermined}, 1.5);
  const auto guesser = track({{}, {}, {}, Censored::undetermined}, -3.0);
  const auto hardly_feels = track({{}, {}, {}, Censored::undetermined}, 18.0);
  const auto person = [&](const std::vector<procedures::ThresholdEstimate>& tracks) {
    return own::person_threshold(tracks, levels);
  };
  CHECK(person({inside, other}) == own::PersonThreshold{{-12.0, -12.0}, Censored::no});
  CHECK(person({above}) == own::PersonThreshold{{0.0, kOpen}, Censored::above});
  CHECK(person({below, below}) == own::PersonThreshold{{-kOpen, -40.0}, Censored::below});
  CHECK(person({near_end}) == own::PersonThreshold{{-1.5, -1.5}, Censored::undetermined});
  CHECK(person({just_beyond}) == own::PersonThreshold{{0.0, kOpen}, Censored::undetermined});
  CHECK(person({guesser}) == own::PersonThreshold{});
  CHECK(person({hardly_feels}) == own::PersonThreshold{{0.0, kOpen}, Censored::undetermined});
  CHECK(person({inside, above}) == own::PersonThreshold{{-5.0, kOpen}, Censored::undetermined});
  CHECK(person({above, below}) == own::PersonThreshold{});
}

TEST_CASE("there is no mean and no median of people most of whom are not determined") {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  const own::PersonThreshold known{{-10.0, -10.0}, Censored::no};
  const own::PersonThreshold other{{-12.0, -12.0}, Censored::no};
  const own::PersonThreshold likely{{-3.0, -3.0}, Censored::undetermined};
  const own::PersonThreshold side{{0.0, kOpen}, Censored::undetermined};
  const own::PersonThreshold nothing{};
  const std::vector some{known, other, likely, nothing};
  const analysis::CensoredMean mean = own::mean_of(some);
  CHECK(mean.mean.has_value());
  CHECK(mean.participants == 3);
  CHECK(mean.exact == 3);
  CHECK(mean.open == 1);
  const std::vector most{known, other, likely, likely, side};
  const analysis::CensoredMean none = own::mean_of(most);
  CHECK(none.lack == analysis::Lack::most);
  CHECK_FALSE(none.mean);
  CHECK_FALSE(none.interval);
  CHECK(none.median_within == analysis::Bounds{});
  CHECK_FALSE(own::p_of(most, 0.0, analysis::Sides::two));
  CHECK(own::difference_of(known, other).censored == Censored::no);
  CHECK(own::difference_of(known, likely).censored == Censored::undetermined);
  CHECK(own::difference_of({{0.0, kOpen}, Censored::above}, known).censored == Censored::above);
  CHECK(own::difference_of(known, {{0.0, kOpen}, Censored::above}).censored == Censored::below);
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

TEST_CASE("the control block's p is the exact tail of guessing") {
  HandMadeTracks made(detection_options());
  made.session();
  made.session();
  made.outside(1, Role::control, 9, 1);
  made.outside(2, Role::control, 5, 5);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.control);
  CHECK(report.control->pooled.answers == analysis::Proportion{20, 14});
  CHECK(report.control->people[0].p.value() == Approx(11.0 / 1024.0).epsilon(1e-12));
  CHECK(report.control->people[0].p_holm.value() == Approx(22.0 / 1024.0).epsilon(1e-12));
  CHECK(report.control->people[1].p.value() == Approx(638.0 / 1024.0).epsilon(1e-12));
  CHECK(report.control->pooled.p.value() == Approx(60460.0 / 1048576.0).epsilon(1e-12));
  CHECK_FALSE(report.catches);
  const auto json = json_of(made);
  CHECK(json.at("control").at("participants").at(0).at("right") == 9);
  CHECK(json.at("catch").is_null());
  CHECK(json.at("control").at("anybody").at("people") == 2);
  CHECK(json.at("control").at("anybody").at("found") == report.control->anybody.found());
}

TEST_CASE("one who hears among eleven who do not is named, and the means without one are beside") {
  std::vector<double> thresholds(12, -20.0);
  HandMadeTracks made = tracks_of(detection_options(), 1, thresholds);
  for (int person = 1; person <= 11; ++person) made.outside(person, Role::control, 10, 10);
  made.outside(12, Role::control, 20, 0);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.control);
  CHECK(report.control->pooled.p.value() > 0.1);
  CHECK(report.control->anybody.found());
  CHECK(report.control->hearers == std::vector<std::string>{"P12"});
  REQUIRE(report.control->without.size() == 1);
  CHECK(report.control->without[0].participants == 11);
  CHECK(report.standards[0].mean.participants == 12);
  const auto json = json_of(made);
  const auto& control = json.at("control");
  CHECK(control.at("hearers") == nlohmann::json{"P12"});
  CHECK(control.at("without_hearers").at(0).at("standard") == "bark");
  CHECK(control.at("without_hearers").at(0).at("participants") == 11);
  CHECK(control.at("without_hearers").at(0).at("mean") ==
        Approx(report.control->without[0].mean.value()));
  const analysis::Document page =
      own::threshold_analysis().results(made.outcomes, {})->document({}, {});
  CHECK(has_table(page, "control", "thresholds-without-hearers"));
}

TEST_CASE("a control block in which nobody stands out says what it could have found") {
  HandMadeTracks made = tracks_of(detection_options(), 1, std::vector<double>(12, -20.0));
  for (int person = 1; person <= 12; ++person) made.outside(person, Role::control, 10, 10);
  const auto json = json_of(made);
  const auto& control = json.at("control");
  CHECK(control.at("anybody").at("found") == false);
  CHECK(control.at("detectable").at("right") == 17);
  CHECK(control.at("detectable").at("share") == Approx(0.882953171453178));
  CHECK(control.at("hearers").empty());
  CHECK(control.at("without_hearers").empty());
  const analysis::Document page =
      own::threshold_analysis().results(made.outcomes, {})->document({}, {});
  CHECK_FALSE(has_table(page, "control", "thresholds-without-hearers"));
}

TEST_CASE("sound that is heard stands beside the thresholds, in the result") {
  HandMadeTracks made = tracks_of(detection_options(), 1, {-20.0});
  made.outside(1, Role::control, 20, 0);
  const analysis::Document page =
      own::threshold_analysis().results(made.outcomes, {})->document({}, {});
  REQUIRE(page.sections.front().id == "result");
  std::string said;
  for (const analysis::Block& block : page.sections.front().blocks) {
    if (const auto* text = std::get_if<analysis::Cited>(&block)) said += text->text;
  }
  CHECK_THAT(said, names("20") && holds_text("bark: −"));
}

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
  CHECK(preferences.at("anybody").at("found") == report.preferences.anybody.found());
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

TEST_CASE("a preferred interval is its share named less its share of targets") {
  HandMadeTracks made(detection_options());
  for (int person = 1; person <= 3; ++person) {
    made.session();
    for (int i = 0; i < 10; ++i) made.answer({person, 1, 20, i % 2, i < 7 + person ? 0 : 1});
  }
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.choice_use.size() == 2);
  CHECK(report.choice_use[0].named == 8 + 9 + 10);
  CHECK(report.choice_use[0].targets == 15);
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
  CHECK(middle.same_at_all == analysis::Proportion{30, 3});
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
