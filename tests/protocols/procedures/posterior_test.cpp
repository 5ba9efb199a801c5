#include "protocols/procedures/posterior.hpp"

#include "protocols/procedures/simulated_tracks.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

using namespace touchtrial;
using namespace touchtrial::procedures;
using namespace touchtrial::tracked;

namespace {

/// One observer of a grid and how much it is believed, in long double.
struct Believed {
  std::array<double, 3> at;  ///< threshold, slope, lapse
  long double weight = 1.0L;
};

/// The definitions, one after the other: no table, no rearranged sum.
class SlowPosterior {
 public:
  SlowPosterior(std::vector<double> levels, const ParameterGrid& grid)
      : levels_(std::move(levels)), guess_(grid.guess) {
    for (const double t : grid.thresholds) {
      for (const double s : grid.slopes) {
        for (const double l : grid.lapses) believed_.push_back({{t, s, l}});
      }
    }
    for (Believed& one : believed_) one.weight /= static_cast<long double>(believed_.size());
  }

  [[nodiscard]] long double correct_share(const Believed& one, double level) const {
    const auto [t, s, l] = one.at;
    const long double hazard = std::pow(10.0L, static_cast<long double>(s) * (level - t) / 20.0L);
    return 1.0L - l - (1.0L - guess_ - l) * std::exp(-hazard);
  }

  /// \return the probability of the answer
  static long double learn(const SlowPosterior& of, std::vector<Believed>& believed, double level,
                           bool correct) {
    long double sum = 0.0L;
    for (Believed& one : believed) {
      const long double share = of.correct_share(one, level);
      one.weight *= correct ? share : 1.0L - share;
      sum += one.weight;
    }
    for (Believed& one : believed) one.weight /= sum;
    return sum;
  }

  void observe(std::size_t level, bool correct) {
    learn(*this, believed_, levels_[level], correct);
  }

  [[nodiscard]] double expected_entropy(std::size_t level, Nuisance nuisance) const {
    long double expected = 0.0L;
    for (const bool correct : {true, false}) {
      std::vector<Believed> after = believed_;
      const long double p = learn(*this, after, levels_[level], correct);
      std::map<std::tuple<double, double, double>, long double> of_interest;
      for (const Believed& one : after) {
        const bool slope = nuisance != Nuisance::slope_and_lapse;
        const bool lapse = nuisance == Nuisance::none;
        of_interest[{one.at[0], slope ? one.at[1] : 0.0, lapse ? one.at[2] : 0.0}] += one.weight;
      }
      for (const auto& [at, q] : of_interest) expected -= q > 0.0L ? p * q * std::log(q) : 0.0L;
    }
    return static_cast<double>(expected);
  }

  [[nodiscard]] const std::vector<Believed>& believed() const { return believed_; }

 private:
  std::vector<double> levels_;
  double guess_;
  std::vector<Believed> believed_;
};

/// Levels that a procedure names for answers written as C and I.
std::vector<int> levels_for(const TrackSettings& settings, const std::string& answers) {
  RandomStream unused(1, "test");
  const std::unique_ptr<Procedure> procedure = make_procedure(settings, unused);
  std::vector<int> levels;
  for (const char answer : answers) {
    levels.push_back(static_cast<int>(settings.levels[procedure->next()]));
    procedure->answer(answer == 'C');
  }
  return levels;
}

Posterior posterior_after(const TrackSettings& settings, const std::vector<int>& levels,
                          const std::string& answers) {
  Posterior posterior(settings.levels, settings.grid);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    posterior.observe(static_cast<std::size_t>(levels[i] + 40), answers[i] == 'C');
  }
  return posterior;
}

TrackSettings watson_track(const std::vector<double>& slopes, const std::vector<double>& lapses) {
  return {.levels = decibels(-40, 0),
          .grid = {Shape::weibull, decibels(-40, 0), slopes, 0.5, lapses}};
}

}  // namespace

// Levels, answers, modes and the mean: Watson 2017 as the tests of hoechenberger/questplus state
// it.
TEST_CASE("QUEST+ names the levels of Watson's first example") {
  const TrackSettings settings = watson_track({3.5}, {0.02});
  const std::string answers = "CCCCIICCCCCCCCICCICCICCCCCCCCCCC";
  const std::vector<int> expected{-18, -22, -25, -28, -30, -22, -13, -15, -16, -18, -19,
                                  -20, -21, -22, -23, -19, -20, -20, -18, -18, -19, -17,
                                  -17, -18, -18, -18, -19, -19, -19, -19, -19, -19};
  CHECK(levels_for(settings, answers) == expected);
  const Posterior posterior = posterior_after(settings, expected, answers);
  CHECK(posterior.mode().threshold == -20.0);
  CHECK(mean_of(posterior.threshold()) == Approx(-20.39360311638961).margin(1e-9));
}

TEST_CASE("QUEST+ names the levels of Watson's implementation example, with slopes") {
  const TrackSettings settings = watson_track({2, 3, 4, 5}, {0.02});
  const std::string answers = "CICCCCCCCCCCCICCICCCICCCCICCCCCCCCCCCICCIICCCCICICCCICCCCCCCCCCC";
  const std::vector<int> expected{-18, -22, -12, -13, -15, -16, -17, -18, -19, -21, -24, -25, -26,
                                  -27, -21, -22, -23, -20, -20, -20, -21, -19, -19, -20, -20, -20,
                                  -19, -19, -19, -19, -19, -20, -20, -20, -20, -20, -21, -21, -20,
                                  -20, -20, -19, -18, -18, -19, -19, -19, -18, -18, -17, -18, -18,
                                  -18, -17, -17, -17, -17, -17, -17, -17, -18, -18, -18, -18};
  CHECK(levels_for(settings, answers) == expected);
  const Observer mode = posterior_after(settings, expected, answers).mode();
  CHECK(mode.threshold == -20.0);
  CHECK(mode.slope == 3.0);
}

TEST_CASE("QUEST+ names the levels of Watson's second example, with slopes and lapses") {
  const TrackSettings settings = watson_track({2, 3, 4, 5}, {0.0, 0.01, 0.02, 0.03, 0.04});
  const std::string answers =
      "CCCCIICCCCCCCCICICCCCCCCICCCCCCCCICCCCCCCCCICCCICCCCCCCCICCC"
      "CCCICCCCCCCCCCCCCICICCCCICCICCCCCCCICCCCCCCCCCCCCCCICCCICIICCCCICCCC";
  const std::vector<int> expected{
      -18, -22, -25, -28, -30, -21, -12, -14, -15, -16, -18, -19, -20, -22, -23, -18, -19, -16, -17,
      -17, -18, -18, -18, -19, -19, -17, -17, -18, -18, -18, -18, -19, -19, -20, -18, -18, -18, -18,
      -18, -19, -19, -19, -19, -20, -18, -18, -18, -18, -18, -18, -18, -18, -18, -19, -19, -19, -20,
      -18, -18, -18, -18, -19, -19, -19, -18, -18, -18, -18, -19, -19, -19, -19, -19, -19, -19, -19,
      -20, -21, -19, -19, -19, -19, -19, -19, -19, -18, -19, -19, -16, -16, -16, -16, -16, -16, 0,
      0,   -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -21, -21, -19, -19,
      -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19};
  // Far above threshold the last levels tie; of these questplus takes its first exact least, 0 dB.
  Posterior posterior(settings.levels, settings.grid);
  int ties = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::vector<double> entropies = posterior.expected_entropies(Nuisance::none);
    const double least = *std::min_element(entropies.begin(), entropies.end());
    const auto theirs = static_cast<std::size_t>(expected[i] + 40);
    const std::size_t ours = posterior.best_level(Nuisance::none);
    CHECK(entropies[theirs] <= least + 1e-9);
    CHECK(ours <= theirs);
    ties += ours != theirs ? 1 : 0;
    posterior.observe(theirs, answers[i] == 'C');
  }
  CHECK(ties == 2);
  const Observer mode = posterior_after(settings, expected, answers).mode();
  CHECK(mode.threshold == -20.0);
  CHECK(mode.slope == 5.0);
  CHECK(mode.lapse == Approx(0.04));
}

TEST_CASE("expected entropies and weights equal those of the definitions in long double") {
  const std::vector<double> levels = decibels(-30, -4, 2);
  const ParameterGrid grid{
      Shape::weibull, decibels(-28, -8, 4), {1.5, 3, 6}, 0.5, {0.0, 0.02, 0.05}};
  Posterior fast(levels, grid);
  SlowPosterior slow(levels, grid);
  RandomStream random(7, "test");
  for (int trial = 0; trial < 25; ++trial) {
    for (const Nuisance nuisance : {Nuisance::none, Nuisance::lapse, Nuisance::slope_and_lapse}) {
      const std::vector<double> entropies = fast.expected_entropies(nuisance);
      for (std::size_t i = 0; i < levels.size(); ++i) {
        CHECK(entropies[i] == Approx(slow.expected_entropy(i, nuisance)).margin(1e-12));
      }
    }
    const auto level = static_cast<std::size_t>(random.below(levels.size()));
    const bool correct = random.uniform() < 0.75;
    fast.observe(level, correct);
    slow.observe(level, correct);
    for (std::size_t i = 0; i < fast.weights().size(); ++i) {
      CHECK(fast.weights()[i] ==
            Approx(static_cast<double>(slow.believed()[i].weight)).margin(1e-12));
    }
  }
}

TEST_CASE("of levels that tell equally much, the smallest is taken") {
  CHECK(first_min(std::array{2.0, 1.0 + 5e-10, 1.0, 3.0}) == 1);
  CHECK(first_min(std::array{2.0, 1.0 + 2e-9, 1.0, 1.0}) == 2);
  // Nothing is to be learned: every level ties.
  TrackSettings known = watson_track({3.5}, {0.02});
  known.grid.thresholds = {-20.0};
  CHECK(levels_for(known, "CIC") == std::vector<int>{-40, -40, -40});
}

TEST_CASE("an answer that all believed observers exclude leaves the posterior as it was") {
  // Always right at a level far above threshold, without lapses.
  Posterior posterior(std::array{-40.0, 60.0}, {Shape::weibull, {-20.0, -10.0}, {6.0}, 0.5, {0.0}});
  posterior.observe(1, false);
  CHECK(posterior.weights() == std::vector<double>{0.5, 0.5});
  for (const double entropy : posterior.expected_entropies(Nuisance::none)) {
    CHECK(entropy == Approx(std::log(2.0)).margin(1e-9));
  }
}

TEST_CASE("mean and SD are those of a known distribution") {
  const Marginal flat{decibels(0, 99), std::vector<double>(100, 0.01)};
  CHECK(mean_of(flat) == Approx(49.5));
  CHECK(sd_of(flat) == Approx(std::sqrt((100.0 * 100.0 - 1.0) / 12.0)));
}

TEST_CASE("impossible grids are refused") {
  const std::vector<double> levels = decibels(-40, 0);
  const auto refused = [&](void (*change)(ParameterGrid&)) {
    ParameterGrid bad{Shape::weibull, {-20.0, -10.0}, {3.0}, 0.5, {0.02}};
    change(bad);
    CHECK_THROWS_AS(Posterior(levels, bad), std::invalid_argument);
  };
  refused([](ParameterGrid& bad) { bad.slopes = {}; });
  refused([](ParameterGrid& bad) { bad.thresholds = {-10.0, -10.0}; });
  refused([](ParameterGrid& bad) { bad.threshold_prior = {0.0, 0.0}; });
  refused([](ParameterGrid& bad) { bad.lapses = {0.6}; });
  refused([](ParameterGrid& bad) {
    bad.thresholds = decibels(0, 9999);
    bad.slopes = decibels(1, 100);
  });
}
