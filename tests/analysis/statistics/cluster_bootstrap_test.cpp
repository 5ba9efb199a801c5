#include "analysis/statistics/cluster_bootstrap.hpp"

#include "analysis/statistics/descriptive.hpp"
#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

/// The results of all n^n ways to draw five participants, sorted.
std::vector<double> every_draw(const std::vector<analysis::Proportion>& five) {
  std::vector<double> shares;
  for (int draw = 0; draw < 3125; ++draw) {
    double n = 0.0;
    double correct = 0.0;
    for (int k = 0, rest = draw; k < 5; ++k, rest /= 5) {
      n += five[rest % 5].n;
      correct += five[rest % 5].correct;
    }
    shares.push_back(correct / n);
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

}  // namespace

TEST_CASE("cluster_bootstrap finds the quantiles of all possible draws") {
  const std::vector<analysis::Proportion> five{{25, 12}, {24, 20}, {25, 25}, {20, 13}, {25, 18}};
  const std::vector<double> shares = every_draw(five);
  const analysis::Interval interval = *analysis::cluster_bootstrap(five, 0, 99'999);
  // Five participants: t of 4 degrees is 2.7764, times sqrt(5 / 4) 3.1041; below minus that lie
  // .000954. Four standard errors of that share in 99,999 draws are .0004.
  CHECK(interval.low >= shares[static_cast<std::size_t>(0.0005 * 3125)]);
  CHECK(interval.low <= shares[static_cast<std::size_t>(0.0014 * 3125)]);
  CHECK(interval.high >= shares[static_cast<std::size_t>(0.9986 * 3125) - 1]);
  CHECK(interval.high <= shares[static_cast<std::size_t>(0.9995 * 3125)]);
}

TEST_CASE("With two participants a bootstrap gives the two") {
  const std::vector<analysis::Proportion> two{{25, 10}, {25, 20}};
  CHECK(analysis::cluster_bootstrap(two) == analysis::Interval{0.4, 0.8});
  const std::vector<double> values{-0.25, 0.5};
  CHECK(analysis::bootstrap_mean(values) == analysis::Interval{-0.25, 0.5});
}

TEST_CASE("cluster_bootstrap weighs participants by their trials") {
  // All draws of one participant only are a quarter each; the mixed one is 10/110, not the mean.
  const std::vector<analysis::Proportion> two{{100, 0}, {10, 10}};
  CHECK(analysis::cluster_bootstrap(two, 0, 9999, 0.2)->low == Approx(10.0 / 110.0));
}

TEST_CASE("bootstrap_mean of many values nears the normal interval of their mean") {
  RandomStream random(3, "bootstrap test");
  std::vector<double> values(400);
  for (double& value : values) value = random.normal();
  double mean = 0.0;
  for (const double value : values) mean += value / 400.0;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double error = std::sqrt(squares) / 400.0;
  const analysis::Interval interval = *analysis::bootstrap_mean(values);
  // The Monte-Carlo error of a 2.5 % quantile of 9,999 is .027 standard errors of the mean.
  CHECK(std::abs(interval.low - (mean - 1.96 * error)) < 0.15 * error);
  CHECK(std::abs(interval.high - (mean + 1.96 * error)) < 0.15 * error);
}

TEST_CASE("the bootstrap of any statistic, here a mean, nears that of means") {
  const std::vector<double> values{0.2, 0.5, 0.6, 0.9, 0.4, 0.3, 0.8, 0.7};
  const auto mean = [&](std::span<const std::size_t> drawn) {
    double sum = 0.0;
    for (const std::size_t i : drawn) sum += values[i];
    return sum / static_cast<double>(drawn.size());
  };
  const analysis::Interval known = *analysis::bootstrap_mean(values, 0, 49'999);
  const analysis::Interval found = *analysis::bootstrap_statistic(values.size(), mean, 0, 49'999);
  CHECK(found.low == Approx(known.low).margin(0.01));
  CHECK(found.high == Approx(known.high).margin(0.01));
  CHECK(found == analysis::bootstrap_statistic(values.size(), mean, 0, 49'999));
  CHECK_FALSE(analysis::bootstrap_statistic(1, mean));
  const auto nothing = [](std::span<const std::size_t>) { return std::nan(""); };
  CHECK_THROWS_AS(analysis::bootstrap_statistic(3, nothing), std::invalid_argument);
}

TEST_CASE("A bootstrap repeats itself, and another index gives other draws") {
  std::vector<analysis::Proportion> participants;
  std::vector<double> values;
  for (int i = 0; i < 30; ++i) {
    participants.push_back({25, (7 * i) % 26});
    values.push_back(std::sin(i));
  }
  CHECK(analysis::cluster_bootstrap(participants) == analysis::cluster_bootstrap(participants));
  CHECK(analysis::bootstrap_mean(values) == analysis::bootstrap_mean(values));
  CHECK_FALSE(analysis::bootstrap_mean(values, 1) == analysis::bootstrap_mean(values, 2));
}

TEST_CASE("A bootstrap's interval moves and scales with its values") {
  const std::vector<double> values{0.1, 0.4, -0.3, 0.25, 0.9, 0.0, -0.6};
  std::vector<double> other;
  for (const double value : values) other.push_back(3.0 - 2.0 * value);
  const analysis::Interval interval = *analysis::bootstrap_mean(values, 5);
  const analysis::Interval moved = *analysis::bootstrap_mean(other, 5);
  CHECK(moved.low == Approx(3.0 - 2.0 * interval.high).margin(1e-12));
  CHECK(moved.high == Approx(3.0 - 2.0 * interval.low).margin(1e-12));
}

TEST_CASE("A bootstrap of equal participants has an interval without width") {
  const std::vector<analysis::Proportion> alike(10, analysis::Proportion{25, 25});
  CHECK(analysis::cluster_bootstrap(alike) == analysis::Interval{1.0, 1.0});
  CHECK(analysis::bootstrap_mean(std::vector<double>(10, 0.5)) == analysis::Interval{0.5, 0.5});
}

TEST_CASE("A bootstrap gives nothing with fewer than two participants") {
  const std::vector<analysis::Proportion> one{{25, 20}};
  CHECK_FALSE(analysis::cluster_bootstrap(one).has_value());
  CHECK_FALSE(analysis::cluster_bootstrap({}).has_value());
  CHECK_FALSE(analysis::bootstrap_mean(std::vector<double>{0.3}).has_value());
}

TEST_CASE("A bootstrap refuses impossible arguments") {
  const std::vector<analysis::Proportion> empty{{25, 20}, {0, 0}};
  CHECK_THROWS_AS(analysis::cluster_bootstrap(empty), std::invalid_argument);
  const std::vector<analysis::Proportion> impossible{{25, 20}, {5, 6}};
  CHECK_THROWS_AS(analysis::cluster_bootstrap(impossible), std::invalid_argument);
  const std::vector<analysis::Proportion> two{{25, 20}, {25, 10}};
  CHECK_THROWS_AS(analysis::cluster_bootstrap(two, 0, 0), std::invalid_argument);
  CHECK_THROWS_AS(analysis::cluster_bootstrap(two, 0, 99, 1.0), std::invalid_argument);
  const std::vector<double> infinite{1.0, std::numeric_limits<double>::infinity()};
  CHECK_THROWS_AS(analysis::bootstrap_mean(infinite), std::invalid_argument);
}

TEST_CASE("the bootstrap of a ratio draws whole participants, and has no infinite end") {
  const std::vector<analysis::Ratio> alike(6, {3.0, 2.0});
  CHECK(analysis::bootstrap_ratio(alike).value().low == Approx(1.5));
  CHECK(analysis::bootstrap_ratio(alike).value().high == Approx(1.5));
  CHECK_FALSE(analysis::bootstrap_ratio(std::vector<analysis::Ratio>{{1.0, 2.0}}).has_value());
  const std::vector<analysis::Ratio> often_infinite{{1.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  CHECK_FALSE(analysis::bootstrap_ratio(often_infinite).has_value());
  const std::vector<analysis::Ratio> negative{{1.0, -1.0}, {1.0, 1.0}};
  CHECK_THROWS_AS(analysis::bootstrap_ratio(negative), std::invalid_argument);
}

TEST_CASE("the bootstrap of a ratio with equal denominators is that of a mean") {
  std::vector<analysis::Ratio> ratios;
  std::vector<double> values;
  RandomStream random(1, "bootstrap of a ratio");
  for (int i = 0; i < 20; ++i) {
    values.push_back(1.0 + random.uniform());
    ratios.push_back({values.back(), 1.0});
  }
  const analysis::Interval ratio = analysis::bootstrap_ratio(ratios, 0, 49'999).value();
  const analysis::Interval mean = analysis::bootstrap_mean(values, 0, 49'999).value();
  CHECK(ratio.low == Approx(mean.low).margin(0.005));
  CHECK(ratio.high == Approx(mean.high).margin(0.005));
}

/// The statistic of all values but each.
template <typename Statistic>
std::vector<double> without_each(const std::vector<double>& values, Statistic statistic) {
  std::vector<double> results;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double> others = values;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    results.push_back(statistic(others));
  }
  return results;
}

TEST_CASE("the jackknife of a mean is the mean with Student's t interval") {
  const std::vector<double> values{0.2, 0.4, 0.45, 0.7, 0.5};
  const auto mean = [](const std::vector<double>& of) { return analysis::mean_of(of); };
  const analysis::JackknifeEstimate found =
      analysis::jackknife(mean(values), without_each(values, mean), {0.0, 1.0});
  const analysis::MeanEstimate expected = analysis::participant_mean(values);
  CHECK(found.value == Approx(*expected.mean).epsilon(1e-12));
  CHECK(found.interval.low == Approx(expected.interval.low).epsilon(1e-12));
  CHECK(found.interval.high == Approx(expected.interval.high).epsilon(1e-12));
}

TEST_CASE("the jackknife takes the bias from a variance, and stays within the range") {
  const std::vector<double> values{0.2, 0.4, 0.45, 0.7, 0.5};
  const auto variance = [](const std::vector<double>& of) {
    const double sd =
        analysis::standard_deviation(of, analysis::mean_of(of), static_cast<double>(of.size()));
    return sd * sd;
  };
  const std::vector<double> without = without_each(values, variance);
  const analysis::JackknifeEstimate found =
      analysis::jackknife(variance(values), without, {0.0, 1.0});
  CHECK(found.value == Approx(variance(values) * 5.0 / 4.0).epsilon(1e-12));
  const analysis::JackknifeEstimate cut =
      analysis::jackknife(variance(values), without, {0.03, 0.031});
  CHECK(cut.value == 0.031);
  CHECK(cut.interval == analysis::Interval{0.03, 0.031});
  CHECK_THROWS_AS(analysis::jackknife(1.0, std::vector<double>{1.0}, {}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::jackknife(std::nan(""), without, {}), std::invalid_argument);
}

}  // namespace touchtrial
