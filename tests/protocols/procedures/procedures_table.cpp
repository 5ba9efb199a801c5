/// \file Prints docs/procedures-recovery.md: procedures_table RUNS; the time that a trial takes:
/// procedures_table speed; fits by maximum likelihood, a JSON object a line, for
/// scripts/crosscheck-procedures: procedures_table fits TRACKS.
#include "core/parallel.hpp"
#include "protocols/procedures/simulated_tracks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <utility>

#include <fmt/format.h>

using namespace touchtrial;
using namespace touchtrial::procedures;
using namespace touchtrial::tracked;

namespace {

/// What one simulated track gives, and the truth.
struct Outcome {
  Threshold threshold;
  double truth = 0.0;
  double slope_ratio = 0.0;  ///< estimated over true; 0 without an estimate
};

using Estimator =
    std::function<Outcome(const TrackSettings&, const std::vector<TrackTrial>&, const Observer&)>;

Outcome by_reversals(const TrackSettings& settings, const std::vector<TrackTrial>& trials,
                     const Observer& observer) {
  return {reversal_threshold(settings.levels, trials),
          level_at(observer, convergence_of(settings.up_down))};
}

Outcome by_posterior(const TrackSettings& settings, const std::vector<TrackTrial>& trials,
                     const Observer& observer) {
  const Posterior posterior =
      posterior_of(settings.levels, usual_track("quest-plus", 1).grid, trials);
  return {posterior_threshold(posterior, settings.levels), observer.threshold,
          mean_of(posterior.slope()) / observer.slope};
}

Outcome by_likelihood(const TrackSettings& settings, const std::vector<TrackTrial>& trials,
                      const Observer& observer) {
  const std::vector<LevelCounts> counts = counts_of(settings.levels, trials);
  return {likelihood_threshold(counts, {}), observer.threshold,
          fit_observer(counts, {}).observer.slope / observer.slope};
}

std::vector<Outcome> outcomes_of(const TrackSettings& settings, const Estimator& estimator,
                                 int runs) {
  std::vector<Outcome> all(static_cast<std::size_t>(runs));
  in_parallel(0, all.size(), [&](std::size_t run) {
    const Observer observer = some_observer(run);
    all[run] = estimator(settings, answered_track(settings, observer, run), observer);
  });
  return all;
}

double median_slope_ratio(const std::vector<Outcome>& all) {
  std::vector<double> ratios;
  for (const Outcome& one : all) ratios.push_back(one.slope_ratio);
  std::sort(ratios.begin(), ratios.end());
  return ratios[ratios.size() / 2];
}

void print_row(const std::string& procedure, int trials, const std::string& estimate,
               const std::vector<Outcome>& all) {
  double n = 0.0, sum = 0.0, squares = 0.0, intervals = 0.0, covered = 0.0, width = 0.0,
         closed = 0.0;
  for (const Outcome& one : all) {
    if (!one.threshold.level) continue;
    const double error = *one.threshold.level - one.truth;
    n += 1.0;
    sum += error;
    squares += error * error;
    if (estimate == "reversals") continue;
    intervals += 1.0;
    const bool holds = one.threshold.low.value_or(-1e9) <= one.truth &&
                       one.truth <= one.threshold.high.value_or(1e9);
    covered += holds ? 1.0 : 0.0;
    if (!one.threshold.low || !one.threshold.high) continue;
    closed += 1.0;
    width += *one.threshold.high - *one.threshold.low;
  }
  const std::string coverage = intervals > 0.0
                                   ? fmt::format("{:.3f} | {:.1f} | {:.2f}", covered / intervals,
                                                 width / closed, median_slope_ratio(all))
                                   : "- | - | -";
  fmt::print("| {} | {} | {} | {:.3f} | {:+.2f} | {:.2f} | {} |\n", procedure, trials, estimate,
             1.0 - n / static_cast<double>(all.size()), sum / n, std::sqrt(squares / n), coverage);
  std::fflush(stdout);
}

void print_goodness_of_fit(int runs) {
  const TrackSettings settings = usual_track("constant-stimuli", 120);
  std::vector<double> p(static_cast<std::size_t>(runs));
  in_parallel(0, p.size(), [&](std::size_t run) {
    const std::vector<TrackTrial> trials = answered_track(settings, some_observer(run), run);
    RandomStream draws(run, "table/goodness");
    p[run] = goodness_of_fit(counts_of(settings.levels, trials), {}, 199, draws).p;
  });
  double rejected = 0.0;
  for (const double one : p) rejected += one <= 0.05 ? 1.0 : 0.0;
  fmt::print(
      "\nGoodness of fit (constant stimuli, 120 trials at six levels, 199 draws, {} runs) rejects\n"
      "{:.3f} of true functions at .05.\n",
      runs, rejected / runs);
}

void print_speed(const char* name, const TrackSettings& settings, Nuisance nuisance) {
  constexpr int kTrials = 30;
  const auto seconds_since = [](std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const auto begin = std::chrono::steady_clock::now();
  Posterior posterior(settings.levels, settings.grid);
  const double tables_s = seconds_since(begin);
  std::vector<double> trials_s;
  for (int i = 0; i < kTrials; ++i) {
    const auto trial = std::chrono::steady_clock::now();
    posterior.observe(posterior.best_level(nuisance), i % 4 != 0);
    trials_s.push_back(seconds_since(trial));
  }
  std::sort(trials_s.begin(), trials_s.end());
  fmt::print(
      "{}, {} levels x {} points: tables {:.1f} ms; a trial {:.2f} ms (median), {:.2f} ms (most)\n",
      name, settings.levels.size(), posterior.weights().size(), 1e3 * tables_s,
      1e3 * trials_s[kTrials / 2], 1e3 * trials_s.back());
}

std::vector<double> evenly(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
  return values;
}

int print_speeds() {
  TrackSettings settings;
  settings.levels = evenly(-60, 0, 61);
  settings.grid = {Shape::weibull, evenly(-50, -10, 41), evenly(1, 6, 21), 0.5, evenly(0, 0.05, 5)};
  print_speed("QUEST+", settings, Nuisance::none);
  print_speed("psi-marginal", settings, Nuisance::lapse);
  settings.levels = evenly(-60, 0, 100);
  settings.grid = {Shape::weibull, evenly(-50, -10, 30), evenly(1, 6, 10), 0.5, evenly(0, 0.1, 40)};
  print_speed("QUEST+", settings, Nuisance::none);
  print_speed("psi-marginal", settings, Nuisance::lapse);
  return 0;
}

std::string counts_json(const std::vector<LevelCounts>& counts) {
  std::string text;
  for (const LevelCounts& at : counts) {
    text += fmt::format("{}[{}, {}, {}]", text.empty() ? "" : ", ", at.level, at.correct, at.n);
  }
  return "[" + text + "]";
}

void print_fit(const char* shape, const std::vector<LevelCounts>& counts,
               const FitOptions& options) {
  const Fit fit = fit_observer(counts, options);
  fmt::print(
      "{{\"shape\": \"{}\", \"lapse\": {}, \"most_lapse\": {}, \"counts\": {}, "
      "\"fit\": {{\"threshold\": {:.17g}, \"slope\": {:.17g}, \"lapse\": {:.17g}, "
      "\"log_likelihood\": {:.17g}, \"deviance\": {:.17g}}}}}\n",
      shape, options.lapse ? fmt::format("{}", *options.lapse) : "null", options.most_lapse,
      counts_json(counts), fit.observer.threshold, fit.observer.slope, fit.observer.lapse,
      fit.log_likelihood, fit.deviance);
}

/// Every shape, with lapses free and without, for tracks of constant stimuli and adaptive ones.
int print_fits(int tracks) {
  for (int track = 0; track < tracks; ++track) {
    const auto seed = static_cast<std::uint64_t>(track);
    const TrackSettings settings =
        usual_track(track % 2 == 0 ? "constant-stimuli" : "quest-plus", track % 2 == 0 ? 240 : 60);
    const std::vector<LevelCounts> counts =
        counts_of(settings.levels, answered_track(settings, some_observer(seed), seed));
    for (const auto& [name, shape] : {std::pair{"weibull", Shape::weibull},
                                      {"logistic", Shape::logistic},
                                      {"normal", Shape::normal}}) {
      print_fit(name, counts, {.shape = shape});
      print_fit(name, counts, {.shape = shape, .lapse = 0.0});
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "speed") return print_speeds();
  if (argc > 2 && std::string(argv[1]) == "fits") return print_fits(std::atoi(argv[2]));
  const int runs = argc > 1 ? std::atoi(argv[1]) : 1000;
  if (runs < 20) return 2;
  fmt::print(
      "# Parameter recovery of thresholds\n\n"
      "`scripts/recovery-procedures {0}` prints this page. Each row: {0} observers, each with one "
      "track.\n"
      "Weibull functions in dB, guess .5, thresholds uniform in -24 .. -14 dB, slopes log-uniform "
      "in 2 .. 6,\n"
      "lapses uniform in 0 .. .05. Settings: [thresholds.md](thresholds.md), \"Defaults\"; "
      "staircases begin at\n"
      "-10 dB; constant stimuli are at -30, -25 .. -5 dB. Bias and RMSE in dB, over tracks that "
      "are not\n"
      "censored; *coverage* of 95 % intervals (Monte-Carlo error {1:.3f}), *width* in dB of those "
      "closed on\n"
      "both sides. Reversals estimate the point of convergence; the others the level with F = 1 - "
      "1/e.\n\n"
      "![Error and coverage of every procedure after 30, 60 and 120 trials]"
      "(images/procedures-recovery.svg)\n\n"
      "(posterior; constant stimuli: likelihood; `scripts/recovery-procedures figure` draws it "
      "from this "
      "table)\n\n"
      "| procedure | trials | estimate | censored | bias | RMSE | coverage | width | slope |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      runs, std::sqrt(0.95 * 0.05 / runs));
  for (const int trials : {30, 60, 120}) {
    for (const std::string name : {"up-down", "weighted-up-down"}) {
      const TrackSettings settings = usual_track(name, trials);
      print_row(name, trials, "reversals", outcomes_of(settings, by_reversals, runs));
      print_row(name, trials, "posterior", outcomes_of(settings, by_posterior, runs));
    }
    for (const std::string name : {"quest-plus", "psi-marginal", "psi-marginal-threshold"}) {
      print_row(name, trials, "posterior",
                outcomes_of(usual_track(name, trials), by_posterior, runs));
    }
    for (const std::string name : {"constant-stimuli", "up-down", "quest-plus"}) {
      print_row(name, trials, "likelihood",
                outcomes_of(usual_track(name, trials), by_likelihood, runs));
    }
  }
  print_goodness_of_fit(runs);
}
