#include "analysis/report/results.hpp"
#include "protocols/threshold/analysis/hand_made_tracks.hpp"
#include "protocols/threshold/analysis/report.hpp"
#include "protocols/threshold/analysis/threshold_analysis.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace own = analysis::threshold;
using procedures::Censored;
using study::Role;

bool has_table(const analysis::Document& page, const std::string& section, const std::string& id) {
  for (const analysis::Section& one : page.sections) {
    for (const analysis::Block* block : all_blocks(one)) {
      const auto* table = std::get_if<analysis::Table>(block);
      if (one.id == section && table != nullptr && table->id == id) return true;
    }
  }
  return false;
}

}  // namespace

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
  CHECK(none.lack == analysis::MissingReason::most);
  CHECK_FALSE(none.mean);
  CHECK_FALSE(none.interval);
  CHECK(none.median_within == analysis::Bounds{});
  CHECK_FALSE(own::p_of(most, 0.0, analysis::Sides::two));
  CHECK(own::difference_of(known, other).censored == Censored::no);
  CHECK(own::difference_of(known, likely).censored == Censored::undetermined);
  CHECK(own::difference_of({{0.0, kOpen}, Censored::above}, known).censored == Censored::above);
  CHECK(own::difference_of(known, {{0.0, kOpen}, Censored::above}).censored == Censored::below);
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
  CHECK(json.at("control").at("anybody").at("found") == report.control->global_null.found());
}

TEST_CASE("one who hears among eleven who do not is named, and the means without one are beside") {
  std::vector<double> thresholds(12, -20.0);
  HandMadeTracks made = tracks_of(detection_options(), 1, thresholds);
  for (int person = 1; person <= 11; ++person) made.outside(person, Role::control, 10, 10);
  made.outside(12, Role::control, 20, 0);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.control);
  CHECK(report.control->pooled.p.value() > 0.1);
  CHECK(report.control->global_null.found());
  CHECK(report.control->hearers == std::vector<std::string>{"P12"});
  REQUIRE(report.control->without_hearers.size() == 1);
  CHECK(report.control->without_hearers[0].participants == 11);
  CHECK(report.standards[0].mean.participants == 12);
  const auto json = json_of(made);
  const auto& control = json.at("control");
  CHECK(control.at("hearers") == nlohmann::json{"P12"});
  CHECK(control.at("without_hearers").at(0).at("standard") == "bark");
  CHECK(control.at("without_hearers").at(0).at("participants") == 11);
  CHECK(control.at("without_hearers").at(0).at("mean") ==
        Approx(report.control->without_hearers[0].mean.value()));
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
    if (const auto* text = std::get_if<analysis::CitedText>(&block)) said += text->text;
  }
  CHECK_THAT(said, names("20") && holds_text("bark: −"));
}

}  // namespace touchtrial
