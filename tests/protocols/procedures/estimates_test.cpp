
#include "protocols/procedures/simulated_tracks.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

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

std::vector<double> levels_of(const std::vector<LevelCounts>& counts) {
  std::vector<double> levels;
  for (const LevelCounts& at : counts) levels.push_back(at.level);
  return levels;
}

/// docs/thresholds.md, "Estimates", as it is written there: a sum for every threshold, width and
/// lapse rate of a fine grid. Only for thresholds with a number and a closed interval.
Threshold estimate_by_definition(const std::vector<LevelCounts>& counts, Shape shape,
                                 double guess) {
  constexpr double kStep_db = 0.2;
  constexpr int kWidths = 50;
  constexpr int kLapses = 80;
  std::vector<double> any;
  std::vector<double> usual;
  const double range = std::max(counts.back().level - counts.front().level, 20.0);
  const double first = counts.front().level - range;
  for (double t = first; t <= counts.back().level + range; t += kStep_db) {
    any.push_back(0.0);
    usual.push_back(0.0);
    for (int w = 0; w < kWidths; ++w) {
      const double width = 2.0 * std::pow(30.0, (w + 0.5) / kWidths);
      const double bell = std::log(width / 10.0) / 0.8;
      for (int l = 0; l < kLapses; ++l) {
        const double lapse = 0.5 * (l + 0.5) / kLapses;
        const Observer observer{shape, t, width_at_slope_one(shape) / width, guess, lapse};
        const double likelihood = std::exp(-0.5 * deviance(observer, counts));
        any.back() += likelihood * std::pow(width, 1.5) * std::pow(1.0 - lapse, 2.0);
        usual.back() += likelihood * std::exp(-0.5 * bell * bell) * std::pow(1.0 - lapse, 9.0);
      }
    }
  }
  const double loss = std::exp(-0.5 * 3.841458820694124);
  const double least = loss * *std::max_element(any.begin(), any.end());
  const auto crossing = [&](std::size_t below, std::size_t above) {
    const double share = std::log(least / any[below]) / std::log(any[above] / any[below]);
    return first +
           kStep_db * std::lerp(static_cast<double>(below), static_cast<double>(above), share);
  };
  std::size_t low = 0;
  while (any[low] < least) ++low;
  std::size_t high = any.size() - 1;
  while (any[high] < least) --high;
  const auto likeliest =
      static_cast<std::size_t>(std::max_element(usual.begin(), usual.end()) - usual.begin());
  REQUIRE(low > 0);
  REQUIRE(high + 1 < any.size());
  REQUIRE(std::max(usual.front(), usual.back()) < loss * usual[likeliest]);
  const double before = std::log(usual[likeliest] / usual[likeliest - 1]);
  const double after = std::log(usual[likeliest] / usual[likeliest + 1]);
  const double inside = 0.5 * (before - after) / (before + after);
  return {first + kStep_db * (static_cast<double>(likeliest) + inside), crossing(low - 1, low),
          crossing(high + 1, high), Censored::no};
}

bool holds(const Threshold& found, double truth) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  return found.low.value_or(-kOpen) <= truth && truth <= found.high.value_or(kOpen);
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
    const TrackSettings settings = usual_track("up-down", 60);
    const Threshold found =
        estimate_of(settings, answered_track(settings, outside, 2), outside, 2).threshold;
    CHECK(found.censored != Censored::no);
    CHECK(found.censored != (threshold < 0.0 ? Censored::above : Censored::below));
    CHECK_FALSE(found.level);
    CHECK_FALSE((threshold < 0.0 ? found.low : found.high));
  }
  const std::array all_wrong{LevelCounts{-30, 0, 20}, LevelCounts{-20, 0, 20},
                             LevelCounts{-10, 1, 20}};
  const Threshold above =
      estimate_threshold(all_wrong, std::array{-30.0, -20.0, -10.0}, Shape::weibull, 0.05)
          .threshold;
  CHECK(above.censored == Censored::above);
  CHECK(above.low == -10.0);
  CHECK_FALSE(above.high);
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

TEST_CASE("the estimate is that of its definition, summed over a fine grid") {
  for (const double guess : {0.5, 1.0 / 3.0}) {
    for (const Shape shape : {Shape::weibull, Shape::logistic, Shape::normal}) {
      const std::vector<LevelCounts> counts = some_counts();
      const Threshold found = estimate_threshold(counts, levels_of(counts), shape, guess).threshold;
      const Threshold slow = estimate_by_definition(counts, shape, guess);
      REQUIRE(found.censored == Censored::no);
      CHECK(*found.low == Approx(*slow.low).margin(0.02));
      CHECK(*found.high == Approx(*slow.high).margin(0.02));
      CHECK(*found.level == Approx(*slow.level).margin(0.02));
    }
  }
}

TEST_CASE("the estimate is that of its definition for many answers at unequal levels") {
  const std::vector<LevelCounts> counts{{-33, 100, 200}, {-24, 121, 200}, {-22.5, 141, 200},
                                        {-20, 171, 200}, {-19, 180, 200}, {-3, 195, 200}};
  const Threshold found =
      estimate_threshold(counts, levels_of(counts), Shape::weibull, 0.5).threshold;
  const Threshold slow = estimate_by_definition(counts, Shape::weibull, 0.5);
  REQUIRE(found.censored == Censored::no);
  CHECK(*found.low == Approx(*slow.low).margin(0.02));
  CHECK(*found.high == Approx(*slow.high).margin(0.02));
  CHECK(*found.level == Approx(*slow.level).margin(0.02));
}

TEST_CASE("answers that tell nothing of the threshold give none") {
  const std::vector<double> levels = decibels(-40, 0, 8);
  const auto of = [&](std::vector<LevelCounts> counts) {
    return estimate_threshold(counts, levels, Shape::weibull, 0.5).threshold;
  };
  const auto is_open = [](const Threshold& found) {
    return found.censored == Censored::undetermined && !found.level && !found.low && !found.high;
  };
  CHECK(is_open(of({})));
  CHECK(is_open(of({{-40, 1, 1}})));
  CHECK(is_open(of({{0, 1, 1}})));
  // Right everywhere: at most so high. Guesses everywhere: at least so high.
  const Threshold right = of({{-40, 6, 6}, {-24, 6, 6}, {0, 6, 6}});
  CHECK_FALSE(right.level);
  CHECK_FALSE(right.low);
  CHECK(right.high.value() < -20.0);
  const Threshold guesses = of({{-40, 10, 20}, {-24, 11, 20}, {-8, 9, 20}, {0, 21, 40}});
  CHECK_FALSE(guesses.level);
  CHECK_FALSE(guesses.high);
  CHECK(guesses.low.value() > -20.0);
}

TEST_CASE("a threshold that is most likely beyond the levels has no number, even if answers rise") {
  const std::array above{LevelCounts{-40, 100, 200}, LevelCounts{-24, 101, 200},
                         LevelCounts{-8, 105, 200}, LevelCounts{0, 132, 200}};
  const std::array below{LevelCounts{-40, 180, 200}, LevelCounts{-32, 199, 200},
                         LevelCounts{-24, 200, 200}, LevelCounts{0, 200, 200}};
  for (const auto& counts : {above, below}) {
    const ThresholdEstimate found =
        estimate_threshold(counts, decibels(-40, 0, 8), Shape::weibull, 0.5);
    CHECK(found.threshold.censored != Censored::no);
    CHECK_FALSE(found.threshold.level);
  }
}

TEST_CASE("a number's interval may leave the levels") {
  const std::array counts{LevelCounts{-40, 5, 10}, LevelCounts{-32, 5, 10}, LevelCounts{-24, 8, 10},
                          LevelCounts{-16, 8, 10}, LevelCounts{-8, 8, 10},  LevelCounts{0, 8, 10}};
  const Threshold found =
      estimate_threshold(counts, decibels(-40, 0, 8), Shape::weibull, 0.5).threshold;
  CHECK(found.censored == Censored::no);
  CHECK(found.level.value() == Approx(-25.1).margin(0.1));
  CHECK(found.low.value() < -40.0);
  CHECK(found.high.value() < 0.0);
}

TEST_CASE("one level has no number, however many answers it has") {
  for (const std::int64_t correct : {0, 50, 80, 100}) {
    const Threshold found = estimate_threshold(std::array{LevelCounts{-20, correct, 100}},
                                               std::array{-20.0}, Shape::weibull, 0.5)
                                .threshold;
    CHECK(found.censored != Censored::no);
    CHECK_FALSE(found.level);
  }
}

TEST_CASE("thousands of answers and tiny or huge ranges of levels give finite estimates") {
  const std::array many{LevelCounts{-20, 10'100, 20'000}, LevelCounts{-10, 15'000, 20'000},
                        LevelCounts{0, 19'900, 20'000}};
  const Threshold found =
      estimate_threshold(many, std::array{-20.0, -10.0, 0.0}, Shape::weibull, 0.5).threshold;
  CHECK(found.level.value() == Approx(-8.0).margin(1.5));
  const std::array near{LevelCounts{-1e-3, 6, 10}, LevelCounts{0, 9, 10}};
  CHECK_FALSE(
      estimate_threshold(near, std::array{-1e-3, 0.0}, Shape::weibull, 0.5).threshold.level);
  const std::array far{LevelCounts{-500, 20, 40}, LevelCounts{-250, 39, 40},
                       LevelCounts{0, 40, 40}};
  const Threshold wide =
      estimate_threshold(far, std::array{-500.0, -250.0, 0.0}, Shape::weibull, 0.5).threshold;
  CHECK(wide.low.value() > -500.0);
  CHECK(wide.high.value() < -230.0);
  // Nobody answers like this; the likelihood is too small for a number.
  const std::array absurd{LevelCounts{-20, 20'000, 20'000}, LevelCounts{-10, 0, 20'000}};
  CHECK(estimate_threshold(absurd, std::array{-20.0, -10.0}, Shape::weibull, 0.5)
            .threshold.censored == Censored::undetermined);
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
  constexpr int kRuns = 80;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Observer observer = some_observer(run);
    const Threshold found =
        estimate_of(settings, answered_track(settings, observer, run), observer, run).threshold;
    covered += holds(found, observer.threshold) ? 1 : 0;
    if (!found.level) continue;
    ++n;
    error += *found.level - observer.threshold;
  }
  // Four Monte-Carlo errors.
  CHECK(n > 0.78 * kRuns);
  CHECK(std::abs(error / n) < 1.0);
  CHECK(covered > 0.86 * kRuns);
}

TEST_CASE("intervals cover for people who lapse often and for flat functions") {
  const TrackSettings settings = usual_track("quest-plus", 60);
  for (const auto& [slope, lapse] : {std::pair{3.5, 0.2}, {1.17, 0.02}}) {
    int covered = 0;
    int quoted = 0;
    constexpr int kRuns = 60;
    for (std::uint64_t run = 0; run < kRuns; ++run) {
      Observer observer = some_observer(run);
      observer.slope = slope;
      observer.lapse = lapse;
      const Threshold found =
          estimate_of(settings, answered_track(settings, observer, run), observer, run).threshold;
      covered += holds(found, observer.threshold) ? 1 : 0;
      quoted += found.level ? 1 : 0;
    }
    // Four Monte-Carlo errors below .95 and .8.
    CHECK(covered > 0.84 * kRuns);
    CHECK(quoted > 0.6 * kRuns);
  }
}

TEST_CASE("who guesses and who is always right has no threshold") {
  for (const double threshold : {-300.0, 300.0}) {
    const Observer observer{Shape::weibull, threshold, 3.5, 0.5, 0.02};
    int quoted = 0;
    constexpr int kRuns = 40;
    for (std::uint64_t run = 0; run < kRuns; ++run) {
      const TrackSettings settings = usual_track("constant-stimuli", 30);
      const Threshold found =
          estimate_of(settings, answered_track(settings, observer, run), observer, run).threshold;
      quoted += found.level ? 1 : 0;
    }
    CHECK(quoted <= 6);
  }
}

TEST_CASE("impossible data are refused") {
  CHECK_THROWS_AS(fit_observer(std::array{LevelCounts{0, 1, 2}}, {}), std::invalid_argument);
  CHECK_THROWS_AS(fit_observer(std::array{LevelCounts{0, 3, 2}, LevelCounts{1, 1, 2}}, {}),
                  std::invalid_argument);
  CHECK_THROWS_AS(fit_observer(std::array{LevelCounts{1, 1, 2}, LevelCounts{0, 1, 2}}, {}),
                  std::invalid_argument);
  const auto refuse = [](const std::vector<LevelCounts>& counts, const std::vector<double>& levels,
                         double guess, double interval) {
    CHECK_THROWS_AS(estimate_threshold(counts, levels, Shape::weibull, guess, interval),
                    std::invalid_argument);
  };
  refuse(some_counts(), decibels(-30, -5, 5), 0.5, 1.0);
  refuse(some_counts(), decibels(-30, -5, 5), 0.0, 0.95);
  refuse(some_counts(), decibels(-30, -5, 5), 1.0, 0.95);
  refuse(some_counts(), {}, 0.5, 0.95);
  refuse(some_counts(), {0.0, 0.0}, 0.5, 0.95);
  refuse({{0, 3, 2}}, {0.0}, 0.5, 0.95);
  refuse({{1, 1, 2}, {0, 1, 2}}, {0.0, 1.0}, 0.5, 0.95);
  RandomStream random(1, "test");
  CHECK_THROWS_AS(goodness_of_fit(some_counts(), {}, 0, random), std::invalid_argument);
}
