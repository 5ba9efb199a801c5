// How many participants a difference of ratings needs: samples of pools against formulas, and pools
// against the report of the same sessions.
#include "protocols/rating/planning/rating_plan.hpp"

#include "core/errors.hpp"
#include "protocols/rating/analysis/report.hpp"
#include "protocols/rating/planning/planner.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/simulation.hpp"
#include "record/study_store.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::planning::rating;

namespace {

using nlohmann::json;

/// Ratings on a line of people who differ by what is given.
RatingPool pool_of(const std::vector<double>& differences) {
  RatingPool pool{.scales = {{"fit", {0.0, 1.0}, {}}},
                  .people = static_cast<int>(differences.size())};
  for (const double difference : differences) {
    pool.scales[0].people.push_back({0.5 + 0.5 * difference, 0.5 - 0.5 * difference, difference});
  }
  return pool;
}

/// Normal differences: their quantiles, in an order that matters to nobody.
RatingPool normal_pool(double mean, double sd) {
  constexpr int kPeople = 4000;
  const boost::math::normal normal;
  std::vector<double> differences;
  for (int i = 0; i < kPeople; ++i) {
    differences.push_back(mean + sd * boost::math::quantile(normal, (i + 0.5) / kPeople));
  }
  return pool_of(differences);
}

/// A share of so many samples is hardly ever farther from the probability.
double four_errors(double probability, int samples) {
  return 4.0 * std::sqrt(probability * (1.0 - probability) / samples);
}

double t_quantile(int n) {
  return boost::math::quantile(boost::math::students_t(n - 1.0), 0.975);
}

double power_of_t_test(int n, double mean, double sd) {
  const boost::math::non_central_t t(n - 1.0, mean / sd * std::sqrt(n));
  const double bound = t_quantile(n);
  return boost::math::cdf(t, -bound) + boost::math::cdf(boost::math::complement(t, bound));
}

/// The mean SD of n normal values over that of all.
double share_of_sd(int n) {
  return std::sqrt(2.0 / (n - 1.0)) * std::exp(std::lgamma(0.5 * n) - std::lgamma(0.5 * (n - 1)));
}

DifferencePower power_of(const RatingPool& pool, int participants, int runs, double alpha = 0.05) {
  const RatingPlan plan{.participants = {participants}, .runs = runs, .seed = 3, .alpha = alpha};
  return rows_of(pool, plan, 2).at(0).scales.at(0);
}

TinyStudyOptions two_scales(const std::string& trials = R"({"repeats": 1, "catch": 2})") {
  return {.comparison = true,
          .protocol = "rating",
          .section = R"({"scales": [{"id": "fit"}, {"id": "rough", "text": {"en": "How rough?"},
            "low": {"en": "smooth"}, "high": {"en": "rough"}, "points": 7}]})",
          .trials = trials};
}

simulation::SubjectModel quick_subject() {
  simulation::SubjectModel subject;
  subject.feature_noise = 0.2;
  subject.explore_s = 2.0;
  subject.training_passes = 2;
  return subject;
}

RatingPool tiny_pool(const TinyStudy& tiny, const MethodPair& pair,
                     const RatingPoolOptions& options) {
  const session::StimulusSource source(tiny.pack(), tiny.key());
  const simulation::SubjectModel subject = quick_subject();
  return simulated_ratings(tiny.key(), source, subject, pair, options);
}

/// The report of the sessions that `simulate` stores.
analysis::rating::RatingReport report_of(TinyStudy& tiny, int participants, std::uint64_t seed) {
  record::StudyStore store = record::StudyStore::create(
      tiny.next_database(), session::commitment_of(tiny.key(), tiny.pack(), true, false),
      std::chrono::nanoseconds(0), tiny.key().signer());
  simulation::simulate_study(tiny.key(), tiny.pack(), quick_subject(),
                             {.participants = participants, .seed = seed}, store);
  store.close_study(store.events(0).back().at);
  store.unblind(store.events(0).back().at, "the end", false);
  return analysis::rating::make_report(analysis::load_outcomes(store, tiny.key()));
}

/// Those of a tiny study that has its pack.
planning::PowerTools tools_for(const TinyStudy& tiny) {
  return {.subject = quick_subject,
          .key =
              [&tiny] {
                study::StudyKey key = tiny.key();
                key.pack_folder = tiny.pack().folder();
                return key;
              },
          .prepare = [](const study::StudyKey&) {},
          .progress = [](const std::string&) { return study::Progress{}; }};
}

planning::PowerOptions options_with(std::vector<int> participants,
                                    std::vector<std::string> methods = {}) {
  planning::PowerOptions options;
  options.plan = {.participants = std::move(participants), .runs = 40, .seed = 5};
  options.json = true;
  options.methods = std::move(methods);
  options.pool = 4;
  return options;
}

/// Nothing is made for what is refused.
std::string refusal_of(const TinyStudy& tiny, const planning::PowerOptions& options) {
  return message_of<Error>([&] { return rating_planner().power(tiny.key().study, options, {}); });
}

}  // namespace

TEST_CASE("sign flips reject as often as the t test where differences are normal") {
  constexpr int kRuns = 2000;
  for (const int size : {10, 20}) {
    INFO(size);
    const DifferencePower power = power_of(normal_pool(0.1, 0.15), size, kRuns);
    CHECK(power.significant.n == kRuns);
    CHECK(*power.significant.share() == Approx(power_of_t_test(size, 0.1, 0.15)).margin(0.045));
    CHECK(power.power.low < *power.significant.share());
    CHECK(power.power.high > *power.significant.share());
    const double width = 2.0 * t_quantile(size) * 0.15 * share_of_sd(size) / std::sqrt(size);
    CHECK(*power.width == Approx(width).epsilon(0.03));
    CHECK(power.without_interval == 0);
  }
}

TEST_CASE("with random signs the test rejects as often as its patterns of signs allow") {
  constexpr int kRuns = 4000;
  for (const int size : {6, 8, 13}) {
    INFO(size);
    const double attainable = attainable_error(size, 0.05);
    const DifferencePower power = power_of(normal_pool(0.3, 0.1), size, kRuns);
    CHECK(power.false_alarms.n == kRuns);
    CHECK(*power.false_alarms.share() == Approx(attainable).margin(four_errors(attainable, kRuns)));
  }
}

TEST_CASE("a huge difference is always found, and has no interval if all agree") {
  const DifferencePower power = power_of(pool_of(std::vector<double>(12, 0.8)), 6, 500);
  CHECK(power.significant.correct == 500);
  CHECK(power.power.high == 1.0);
  CHECK_FALSE(power.width);
  const DifferencePower varied = power_of(normal_pool(0.6, 0.05), 6, 500);
  CHECK(varied.significant.correct == 500);
}

TEST_CASE("no difference is never found") {
  const DifferencePower power = power_of(pool_of(std::vector<double>(12, 0.0)), 8, 100);
  CHECK(power.significant.correct == 0);
  CHECK(power.false_alarms.correct == 0);
}

TEST_CASE("intervals of ratings end where the scale does") {
  RatingPool pool = pool_of({1.0, -1.0});
  const DifferencePower power = power_of(pool, 2, 50, 0.5);
  CHECK(*power.width <= 2.0);
}

TEST_CASE("people without a difference are missing in samples") {
  RatingPool pool = pool_of({0.5});
  for (int i = 0; i < 10; ++i) pool.scales[0].people.push_back({});
  pool.people = 11;
  const DifferencePower power = power_of(pool, 2, 400, 0.5);
  // Both must be the one with a difference: a sample in 121.
  CHECK(power.without_interval > 385);
}

TEST_CASE("the fewest participants, and the error that sign flips attain") {
  CHECK(min_participants(0.05) == 6);
  CHECK(min_participants(0.01) == 8);
  CHECK(min_participants(0.5) == 2);
  CHECK(attainable_error(5, 0.05) == 0.0);
  CHECK(attainable_error(6, 0.05) == 2.0 / 64.0);
  CHECK(attainable_error(8, 0.05) == 12.0 / 256.0);
  CHECK(attainable_error(33, 0.05) == 0.05);
}

TEST_CASE("rows depend on the seed alone, not on the number of threads") {
  const RatingPool pool = normal_pool(0.1, 0.2);
  RatingPlan plan{.participants = {6, 9}, .runs = 200, .seed = 7};
  RatingPlanReport one{{"study", "people", "a", "b"}, plan, pool, rows_of(pool, plan, 1)};
  RatingPlanReport two{{"study", "people", "a", "b"}, plan, pool, rows_of(pool, plan, 3)};
  CHECK(rating_plan_json(one) == rating_plan_json(two));
  CHECK(rating_plan_text(one) == rating_plan_text(two));
  CHECK_THAT(rating_plan_text(one),
             Catch::Matchers::StartsWith("SIMULATED") && holds_text("Difference: a less b"));
  plan.seed = 8;
  two.rows = rows_of(pool, plan, 1);
  CHECK(rating_plan_json(one) != rating_plan_json(two));
}

TEST_CASE("a pool's ratings are those of the report of the same sessions") {
  TinyStudy tiny(two_scales());
  const RatingPool pool = tiny_pool(tiny, {0, 1}, {.people = 3, .seed = 4, .jobs = 2});
  CHECK(pool.people == 3);
  CHECK(pool.unfinished == 0);
  const analysis::rating::RatingReport report = report_of(tiny, 3, 4);
  REQUIRE(pool.scales.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    INFO(pool.scales[i].id);
    const analysis::rating::ScaleReport& reported = report.scales.at(i);
    CHECK(pool.scales[i].id == reported.scale.id);
    CHECK(pool.scales[i].ends == analysis::rating::ends_of(reported.scale));
    REQUIRE(pool.scales[i].people.size() == 3);
    double first = 0.0;
    double second = 0.0;
    double difference = 0.0;
    for (const PooledRating& one : pool.scales[i].people) {
      first += *one.first / 3.0;
      second += *one.second / 3.0;
      difference += *one.difference / 3.0;
      CHECK(*one.difference == Approx(*one.first - *one.second).margin(1e-9));
    }
    CHECK(first == Approx(*reported.means.methods.at(0).mean.mean));
    CHECK(second == Approx(*reported.means.methods.at(1).mean.mean));
    CHECK(difference == Approx(*reported.differences.at(0).difference.mean).margin(1e-9));
  }
}

TEST_CASE("a pool depends on its seed alone, and methods that change places on nothing but sign") {
  const TinyStudy tiny(two_scales());
  const RatingPool pool = tiny_pool(tiny, {0, 1}, {.people = 3, .seed = 4, .jobs = 2});
  const RatingPool again = tiny_pool(tiny, {0, 1}, {.people = 3, .seed = 4, .jobs = 1});
  const RatingPool other = tiny_pool(tiny, {0, 1}, {.people = 3, .seed = 5, .jobs = 1});
  const RatingPool turned = tiny_pool(tiny, {1, 0}, {.people = 3, .seed = 4, .jobs = 1});
  CHECK(pool.scales[0].people == again.scales[0].people);
  CHECK(pool.scales[0].people != other.scales[0].people);
  for (std::size_t i = 0; i < 3; ++i) {
    const PooledRating& one = pool.scales[0].people[i];
    const PooledRating& back = turned.scales[0].people[i];
    CHECK(one.first == back.second);
    CHECK(one.second == back.first);
    CHECK(*one.difference == -*back.difference);
  }
}

TEST_CASE("ratings at all visits of a participant count") {
  TinyStudyOptions options = two_scales();
  options.visits = R"({"count": 2})";
  TinyStudy tiny(options);
  const RatingPool pool = tiny_pool(tiny, {0, 1}, {.people = 2, .seed = 4});
  const analysis::rating::RatingReport report = report_of(tiny, 2, 4);
  const std::vector<PooledRating>& people = pool.scales[0].people;
  REQUIRE(people.size() == 2);
  CHECK(0.5 * (*people[0].difference + *people[1].difference) ==
        Approx(*report.scales[0].differences.at(0).difference.mean).margin(1e-9));
}

TEST_CASE("`power` reports each scale and size, the same again for a seed") {
  const TinyStudy tiny(two_scales());
  const auto power = [&](const planning::PowerOptions& options) {
    return rating_planner().power(tiny.key().study, options, tools_for(tiny)).text;
  };
  planning::PowerOptions options = options_with({6, 9});
  const std::string text = power(options);
  CHECK(power(options) == text);
  const json report = json::parse(text);
  CHECK(report.at("simulated") == true);
  CHECK(report.at("protocol") == "rating");
  CHECK(report.at("alpha") == 0.05);
  CHECK(report.at("people") == 4);
  REQUIRE(report.at("scales").size() == 2);
  const json& fit = report.at("scales").at(0);
  CHECK(fit.at("scale") == "fit");
  CHECK(fit.at("methods").at(0).at("of") == "adaptive");
  CHECK(fit.at("difference").at("of") == "adaptive less tv-gabor");
  CHECK(fit.at("difference").at("people") == 4);
  REQUIRE(fit.at("sizes").size() == 2);
  const json& size = fit.at("sizes").at(1);
  CHECK(size.at("participants") == 9);
  CHECK(size.at("power").at("samples") == 40);
  CHECK(size.at("type_one_error").at("attainable") == attainable_error(9, 0.05));
  CHECK(size.at("interval_width").get<double>() >= 0.0);
  const json turned = json::parse(power(options_with({6, 9}, {"tv-gabor", "adaptive"})));
  CHECK(turned.at("scales").at(0).at("difference").at("mean").get<double>() ==
        Approx(-fit.at("difference").at("mean").get<double>()).margin(1e-9));
  options.json = false;
  CHECK_THAT(power(options), Catch::Matchers::StartsWith("simulated on: ideal device") &&
                                 holds_text("adaptive less tv-gabor") && holds_text("rough"));
}

TEST_CASE("`power` takes the options of ratings, and refuses impossible ones before any work") {
  const auto taken = rating_planner().options();
  CHECK(std::ranges::find(taken, "--methods") != taken.end());
  CHECK(std::ranges::find(taken, "--pool") != taken.end());
  CHECK(std::ranges::find(taken, "--margin") == taken.end());
  const TinyStudy tiny(two_scales());
  const auto refused = [&](std::vector<int> participants, std::vector<std::string> methods,
                           const std::string& places) {
    const std::string refusal =
        refusal_of(tiny, options_with(std::move(participants), std::move(methods)));
    CHECK_THAT(refusal, names(places));
    CHECK(refusal.find('\n') == std::string::npos);
  };
  refused({8}, {"adaptive", "edge"}, "--methods edge adaptive tv-gabor");
  refused({8}, {"adaptive"}, "--methods");
  refused({8}, {"adaptive", "adaptive"}, "--methods");
  refused({8}, {"adaptive", "tv-gabor", "edge"}, "--methods");
  refused({5, 8}, {}, "--participants 5 0.05 6");
}

TEST_CASE("one method alone has no power") {
  TinyStudyOptions options = two_scales();
  options.comparison = false;
  const TinyStudy tiny(options);
  CHECK_THROWS_AS(rating_planner().power(tiny.key().study, options_with({8}), {}), StudyError);
  CHECK_THAT(refusal_of(tiny, options_with({8})), names("/methods"));
}
