
#include "protocols/procedures/simulated_tracks.hpp"
#include "support/catch.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

using namespace touchtrial;
using namespace touchtrial::procedures;
using namespace touchtrial::tracked;

namespace {

std::vector<TrackTrial> trials_at(const std::vector<std::size_t>& levels) {
  std::vector<TrackTrial> trials;
  for (const std::size_t level : levels) trials.push_back({level, true});
  return trials;
}

/// Counts of a two-interval task at six levels.
std::vector<LevelCounts> some_counts() {
  return {{-30, 11, 20}, {-25, 12, 20}, {-20, 14, 20}, {-15, 18, 20}, {-10, 19, 20}, {-5, 20, 20}};
}

}  // namespace

// Counts and log-likelihoods as SciPy's optimisers find them from many starts:
// scripts/crosscheck-procedures.
TEST_CASE("of several maxima of the likelihood the fit is the highest") {
  const std::vector<LevelCounts> adaptive{{-30, 0, 1}, {-29, 0, 1},   {-28, 2, 2},   {-27, 1, 1},
                                          {-26, 1, 3}, {-25, 12, 14}, {-24, 11, 12}, {-23, 5, 7},
                                          {-22, 8, 9}, {-21, 8, 8},   {-20, 1, 1},   {-18, 1, 1}};
  CHECK(fit_observer(adaptive, {}).log_likelihood == Approx(-24.07940395843588).margin(1e-6));
  const std::vector<LevelCounts> constant{{-30, 18, 40}, {-25, 26, 40}, {-20, 39, 40},
                                          {-15, 40, 40}, {-10, 40, 40}, {-5, 39, 40}};
  const Fit fit = fit_observer(constant, {});
  CHECK(fit.log_likelihood == Approx(-64.2359074648309).margin(1e-6));
  CHECK(fit.observer.slope == Approx(4.1432773).margin(1e-3));
}

TEST_CASE("reversals are the levels where a staircase turns") {
  CHECK(reversals_of(trials_at({5, 5, 4, 3, 3, 4, 5, 5, 4, 4, 5})) ==
        std::vector<std::size_t>{3, 5, 4});
  CHECK(reversals_of(trials_at({5, 4, 3, 2})).empty());
}

TEST_CASE("the reversal threshold averages an even number of the last reversals") {
  const std::vector<double> levels = decibels(0, 9);
  const std::vector<TrackTrial> trials = trials_at({8, 4, 6, 3, 7, 4, 5, 3, 5});
  // Reversals 4 6 3 7 4 5 3; without the first two five are left, so the first of these goes too.
  CHECK(reversal_threshold(levels, trials).level.value() == Approx((7 + 4 + 5 + 3) / 4.0));
  CHECK(reversal_threshold(levels, trials, 1).level.value() ==
        Approx((6 + 3 + 7 + 4 + 5 + 3) / 6.0));
  CHECK_FALSE(reversal_threshold(levels, trials_at({8, 7, 8})).level);
  CHECK_THROWS_AS(reversal_threshold(levels, {}), std::invalid_argument);
}

TEST_CASE("a track that reaches a bound is censored and gives no threshold") {
  const std::vector<double> levels = decibels(0, 9);
  CHECK(reversal_threshold(levels, trials_at({4, 2, 0, 0})).censored == Censored::below);
  CHECK(reversal_threshold(levels, trials_at({8, 9, 9})).censored == Censored::above);
  const Threshold turns = reversal_threshold(levels, trials_at({5, 9, 7, 9, 8, 9, 8}));
  CHECK(turns.censored == Censored::above);
  CHECK_FALSE(turns.level);
  for (const double threshold : {-60.0, 20.0}) {
    const Observer outside{Shape::weibull, threshold, 4.0, 0.5, 0.0};
    const TrackSettings settings = usual_track("quest-plus", 60);
    const std::vector<TrackTrial> trials = answered_track(settings, outside, 2);
    const Threshold found =
        posterior_threshold(posterior_of(settings.levels, settings.grid, trials), settings.levels);
    CHECK(found.censored == (threshold < 0.0 ? Censored::below : Censored::above));
    CHECK_FALSE(found.level);
    CHECK_FALSE(found.low);
  }
  const std::array all_wrong{LevelCounts{-30, 0, 20}, LevelCounts{-20, 0, 20},
                             LevelCounts{-10, 1, 20}};
  FitOptions yes_no{.guess = 0.0};
  CHECK(likelihood_threshold(all_wrong, yes_no).censored == Censored::above);
}

TEST_CASE("a fit finds exact data's own parameters") {
  for (const Shape shape : {Shape::logistic, Shape::weibull, Shape::normal}) {
    const Observer truth{shape, -17.3, shape == Shape::weibull ? 3.1 : 0.4, 0.5, 0.03};
    std::vector<LevelCounts> counts;
    for (double level = -35.0; level <= 0.0; level += 2.5) {
      const std::int64_t n = 1'000'000'000;
      const double share = shares_at(truth, level).correct;
      counts.push_back({level, std::llround(share * static_cast<double>(n)), n});
    }
    const Fit fit = fit_observer(counts, {shape, 0.5});
    CHECK(fit.observer.threshold == Approx(truth.threshold).margin(1e-4));
    CHECK(fit.observer.slope == Approx(truth.slope).epsilon(1e-4));
    CHECK(fit.observer.lapse == Approx(truth.lapse).margin(1e-5));
  }
}

TEST_CASE("no observer of a fine grid is likelier than the fitted one") {
  const std::vector<LevelCounts> counts = some_counts();
  const Fit fit = fit_observer(counts, {});
  double most = -1e300;
  for (double t = -30.0; t <= -5.0; t += 0.1) {
    for (double slope = 0.5; slope < 12.0; slope *= 1.02) {
      for (double lapse = 0.0; lapse <= 0.1001; lapse += 0.005) {
        most = std::max(most, log_likelihood({Shape::weibull, t, slope, 0.5, lapse}, counts));
      }
    }
  }
  CHECK(fit.log_likelihood >= most);
  CHECK(fit.log_likelihood == Approx(most).margin(0.01));
  CHECK(fit.deviance == Approx(deviance(fit.observer, counts)).margin(1e-9));
}

TEST_CASE("the ends of a profile interval lose 1.92 of log-likelihood on a fine grid") {
  const std::vector<LevelCounts> counts = some_counts();
  const FitOptions options{Shape::weibull, 0.5, {}, 0.02};
  const Threshold found = likelihood_threshold(counts, options);
  REQUIRE(found.low);
  REQUIRE(found.high);
  CHECK(*found.low < *found.level);
  CHECK(*found.level < *found.high);
  const double most = fit_observer(counts, options).log_likelihood;
  for (const double end : {*found.low, *found.high}) {
    double held = -1e300;
    for (double slope = 0.1; slope < 40.0; slope *= 1.002) {
      held = std::max(held, log_likelihood({Shape::weibull, end, slope, 0.5, 0.02}, counts));
    }
    CHECK(most - held == Approx(0.5 * 3.841458820694124).margin(0.005));
  }
}

TEST_CASE("goodness of fit keeps a true function and rejects a wrong one") {
  RandomStream random(1, "test");
  const GoodnessOfFit good = goodness_of_fit(some_counts(), {}, 199, random);
  CHECK(good.p > 0.2);
  CHECK(good.thresholds.size() == 199);
  const std::array uneven{LevelCounts{-30, 40, 40}, LevelCounts{-25, 15, 40},
                          LevelCounts{-20, 38, 40}, LevelCounts{-15, 20, 40},
                          LevelCounts{-10, 40, 40}};
  CHECK(goodness_of_fit(uneven, {}, 199, random).p == Approx(1.0 / 200.0));
}

TEST_CASE("thresholds of QUEST+ tracks are unbiased, and their intervals cover") {
  const TrackSettings settings = usual_track("quest-plus", 60);
  double error = 0.0;
  int covered = 0;
  int n = 0;
  for (std::uint64_t run = 0; run < 150; ++run) {
    const Observer observer = some_observer(run);
    const Threshold found = posterior_threshold(
        posterior_of(settings.levels, settings.grid, answered_track(settings, observer, run)),
        settings.levels);
    if (!found.level) continue;
    ++n;
    error += *found.level - observer.threshold;
    covered += *found.low <= observer.threshold && observer.threshold <= *found.high ? 1 : 0;
  }
  CHECK(n > 140);
  // Four Monte-Carlo errors.
  CHECK(std::abs(error / n) < 0.8);
  CHECK(covered > 0.87 * n);
}

TEST_CASE("impossible data are refused") {
  CHECK_THROWS_AS(fit_observer(std::array{LevelCounts{0, 1, 2}}, {}), std::invalid_argument);
  CHECK_THROWS_AS(fit_observer(std::array{LevelCounts{0, 3, 2}, LevelCounts{1, 1, 2}}, {}),
                  std::invalid_argument);
  CHECK_THROWS_AS(fit_observer(std::array{LevelCounts{1, 1, 2}, LevelCounts{0, 1, 2}}, {}),
                  std::invalid_argument);
  CHECK_THROWS_AS(likelihood_threshold(some_counts(), {}, 1.0), std::invalid_argument);
  RandomStream random(1, "test");
  CHECK_THROWS_AS(goodness_of_fit(some_counts(), {}, 0, random), std::invalid_argument);
}
