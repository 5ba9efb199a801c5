// How many participants a mean threshold needs: samples of pools against formulas.
#include "protocols/threshold/planning/threshold_plan.hpp"

#include "core/errors.hpp"
#include "protocols/simulation/simulation.hpp"
#include "protocols/threshold/threshold_study.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <cmath>
#include <limits>
#include <string>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::planning::threshold;

namespace {

constexpr int kPoolPeople = 4000;
constexpr double kOpen = std::numeric_limits<double>::infinity();

/// Two thresholds whose difference is normal: its quantiles, in an order that matters to nobody.
ThresholdPool normal_pool(double mean_difference, double sd) {
  ThresholdPool pool{.trials = 60, .standards = {"one", "other"}, .people = {}};
  const boost::math::normal normal;
  for (int i = 0; i < kPoolPeople; ++i) {
    const double z = boost::math::quantile(normal, (i + 0.5) / kPoolPeople);
    const double other = -20.0 - mean_difference - sd * z;
    pool.people.push_back({{-20.0, -20.0}, {other, other}});
  }
  return pool;
}

double t_quantile(int n) {
  return boost::math::quantile(boost::math::students_t(n - 1.0), 0.975);
}

/// Of the half-width of a normal sample's t interval.
double half_width_quantile(int n, double sd, double share) {
  const double variance =
      boost::math::quantile(boost::math::chi_squared(n - 1.0), share) / (n - 1.0);
  return t_quantile(n) * sd * std::sqrt(variance / n);
}

double power_of_t_test(int n, double mean, double sd) {
  const boost::math::non_central_t t(n - 1.0, mean / sd * std::sqrt(n));
  const double bound = t_quantile(n);
  return boost::math::cdf(t, -bound) + boost::math::cdf(boost::math::complement(t, bound));
}

}  // namespace

TEST_CASE("half-widths of samples from a normal pool are those of the chi-squared distribution") {
  const double sd = 3.0;
  const ThresholdPlan plan{.participants = {6, 12, 30}, .runs = 4000, .seed = 3, .width_db = 2.0};
  const std::vector<ThresholdRow> rows = rows_of(normal_pool(1.0, sd), plan, 2);
  REQUIRE(rows.size() == 3);
  for (const ThresholdRow& row : rows) {
    INFO(row.participants);
    const HalfWidths& width = row.standards.at(1);
    CHECK(*width.median == Approx(half_width_quantile(row.participants, sd, 0.5)).epsilon(0.02));
    CHECK(*width.upper == Approx(half_width_quantile(row.participants, sd, 0.9)).epsilon(0.02));
    const double of_variance = std::pow(2.0 / (t_quantile(row.participants) * sd), 2) *
                               row.participants * (row.participants - 1.0);
    const double expected =
        boost::math::cdf(boost::math::chi_squared(row.participants - 1.0), of_variance);
    CHECK(*width.narrow.share() == Approx(expected).margin(0.03));
    CHECK(width.without_interval == analysis::Proportion{4000, 0});
    // Everybody has the same first threshold, which tells nothing of how people differ.
    CHECK_FALSE(row.standards.at(0).upper.has_value());
    CHECK(row.standards.at(0).without_interval == analysis::Proportion{4000, 4000});
    CHECK_FALSE(row.difference.has_value());
  }
}

TEST_CASE("power and error of a paired comparison are those of the t test") {
  const ThresholdPlan plan{.participants = {8, 20},
                           .runs = 4000,
                           .seed = 5,
                           .difference = std::pair<std::size_t, std::size_t>{0, 1}};
  for (const ThresholdRow& row : rows_of(normal_pool(1.5, 2.5), plan, 2)) {
    INFO(row.participants);
    REQUIRE(row.difference.has_value());
    CHECK(*row.difference->significant.share() ==
          Approx(power_of_t_test(row.participants, 1.5, 2.5)).margin(0.03));
    CHECK(*row.difference->false_alarms.share() == Approx(0.05).margin(0.015));
    CHECK(row.difference->power.low < *row.difference->significant.share());
  }
}

TEST_CASE("rows of a pool do not depend on the number of threads") {
  const ThresholdPlan plan{.participants = {5, 9},
                           .runs = 50,
                           .seed = 7,
                           .width_db = 1.0,
                           .difference = std::pair<std::size_t, std::size_t>{1, 0}};
  ThresholdPlanReport one{{"study", "people", "dB"}, plan, {}};
  ThresholdPlanReport two = one;
  const ThresholdPool pool = normal_pool(1.0, 1.0);
  one.pools.emplace_back(pool, rows_of(pool, plan, 1));
  two.pools.emplace_back(pool, rows_of(pool, plan, 3));
  CHECK(threshold_plan_json(one) == threshold_plan_json(two));
  CHECK(threshold_plan_text(one) == threshold_plan_text(two));
  CHECK_THAT(threshold_plan_text(one),
             Catch::Matchers::StartsWith("SIMULATED") && holds_text("Difference: other less one"));
}

TEST_CASE("most samples of people beyond the levels have no interval, and the plan says so") {
  ThresholdPool pool{.trials = 60, .standards = {"one"}, .people = {}, .above = 10};
  for (int i = 0; i < 10; ++i) pool.people.push_back({{0.0, kOpen}});
  pool.people.push_back({{-20.0, -20.0}});
  const ThresholdPlan plan{.participants = {2}, .runs = 400, .seed = 1, .width_db = 100.0};
  const HalfWidths width = rows_of(pool, plan, 1).front().standards.front();
  CHECK(width.without_interval == analysis::Proportion{400, 400});
  CHECK_FALSE(width.median.has_value());
  CHECK_FALSE(width.upper.has_value());
  CHECK(width.narrow.correct == 400 - width.without_interval.correct);
  ThresholdPlanReport report{{"study", "people", "dB"}, plan, {}};
  report.pools.emplace_back(pool, rows_of(pool, plan, 1));
  const auto document = nlohmann::json::parse(threshold_plan_json(report));
  const auto& size = document.at("trials").at(0).at("sizes").at(0);
  CHECK(size.at("thresholds").at(0).at("half_width_median").is_null());
  CHECK(document.at("trials").at(0).at("thresholds").at(0).at("mean").is_null());
  CHECK_THAT(threshold_plan_text(report), names("10 11"));
}

TEST_CASE("people beyond the levels count in a plan, so the mean is not that of the others") {
  // Normal people of -2 dB on average and an SD of 5 dB; the highest level is 0.
  ThresholdPool pool{.trials = 60, .standards = {"one"}, .people = {}};
  for (int i = 0; i < kPoolPeople; ++i) {
    const double value =
        boost::math::quantile(boost::math::normal(-2.0, 5.0), (i + 0.5) / kPoolPeople);
    pool.people.push_back(
        {value > 0.0 ? analysis::Bounds{0.0, kOpen} : analysis::Bounds{value, value}});
  }
  const analysis::CensoredMean mean = analysis::censored_mean(thresholds_in(pool, 0));
  CHECK(mean.mean.value() == Approx(-2.0).margin(0.05));
  CHECK(mean.sd.value() == Approx(5.0).epsilon(0.01));
  const ThresholdPlan plan{.participants = {20}, .runs = 400, .seed = 2};
  const HalfWidths width = rows_of(pool, plan, 1).front().standards.front();
  // A sample of 20 loses its mean if eleven or more are beyond: in 5 of 100.
  CHECK(width.without_interval.share().value() == Approx(0.05).margin(0.03));
  CHECK(*width.median > half_width_quantile(20, 5.0, 0.5));
}

TEST_CASE("a pool that has no mean difference has no type-I error") {
  ThresholdPool pool{.trials = 60, .standards = {"one", "other"}, .people = {}};
  for (int i = 0; i < 9; ++i) pool.people.push_back({{0.0, kOpen}, {-20.0 - i, -20.0 - i}});
  const ThresholdPlan plan{.participants = {6},
                           .runs = 50,
                           .seed = 1,
                           .difference = std::pair<std::size_t, std::size_t>{0, 1}};
  const ThresholdRow row = rows_of(pool, plan, 1).front();
  CHECK(row.difference->significant == analysis::Proportion{50, 0});
  CHECK(row.difference->false_alarms.n == 0);
  ThresholdPlanReport report{{"study", "people", "dB"}, plan, {}};
  report.pools.emplace_back(pool, rows_of(pool, plan, 1));
  CHECK_NOTHROW(threshold_plan_text(report));
  CHECK(nlohmann::json::parse(threshold_plan_json(report)).at("samples") == 50);
}

TEST_CASE("a pool has the tracks of simulated sessions, with the trials that are asked for") {
  const TinyStudy tiny(threshold_options(
      R"("task": "detection", "interval_s": 0.4, "trials": 8, "control": 5,
         "levels": {"from": -40, "to": 0, "step": 4})"));
  const session::StimulusSource source(tiny.pack(), tiny.key());
  simulation::SubjectModel subject{.feature_noise = 0.05, .training_passes = 2};
  const ThresholdPoolOptions options{.people = 3, .seed = 4, .jobs = 2};
  const ThresholdPool pool = simulated_thresholds(tiny.key(), source, subject, 12, options);
  CHECK(pool.trials == 12);
  CHECK(pool.unfinished == 0);
  CHECK(pool.people.size() == 3);
  CHECK(pool.standards.size() == 5);
  CHECK(pool.tracks == 15);
  int found = 0;
  for (std::size_t standard = 0; standard < 5; ++standard) {
    for (const analysis::Bounds& threshold : thresholds_in(pool, standard)) {
      if (!threshold.exact()) continue;
      CHECK(std::abs(threshold.low + 20.0) <= 20.0);
      ++found;
    }
  }
  // Undetermined thresholds whose likeliest value lies within the levels enter with this value.
  const int known = pool.tracks - pool.below - pool.above - pool.undetermined;
  CHECK(known <= found);
  CHECK(found <= known + pool.undetermined);
  const ThresholdPool again =
      simulated_thresholds(tiny.key(), source, subject, 12, {.people = 3, .seed = 4, .jobs = 1});
  CHECK(again.people == pool.people);
}

TEST_CASE("impossible pools are refused") {
  const auto pool_of = [](const std::string& section, int trials) {
    const TinyStudy tiny(threshold_options(section));
    const session::StimulusSource source(tiny.pack(), tiny.key());
    static_cast<void>(simulated_thresholds(tiny.key(), source, {}, trials, {.people = 1}));
  };
  CHECK_THROWS_WITH(pool_of(R"("task": "detection", "interval_s": 0.4, "trials": 4,
                               "procedure": "constant-stimuli", "levels": [-20, -10])",
                            5),
                    names("--trials 5"));
  CHECK_THROWS_WITH(pool_of(R"("task": "discrimination", "question": "same-different",
                               "interval_s": 0.4, "trials": 4, "procedure": "constant-stimuli",
                               "levels": [-12, -6], "standards": [-6])",
                            4),
                    names("d'"));
}
