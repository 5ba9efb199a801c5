/// \file Prints docs/procedures-recovery.md: procedures_table RUNS; the time that a trial takes:
/// procedures_table speed; fits by maximum likelihood and estimates of thresholds, a JSON object a
/// line, for scripts/crosscheck-procedures: procedures_table fits TRACKS.
#include "core/parallel.hpp"
#include "protocols/procedures/simulated_tracks.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

using namespace touchtrial;
using namespace touchtrial::procedures;
using namespace touchtrial::tracked;

namespace {

/// What one simulated track gives, and the truth.
struct Outcome {
  Threshold threshold;
  double truth = 0.0;
};

struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// Observers who are alike in some respect, drawn uniformly: the slope on a logarithmic scale.
struct Kind {
  std::string words;
  Shape shape = Shape::weibull;
  Range threshold{-24.0, -14.0};
  Range slope{2.0, 6.0};
  Range lapse{0.0, 0.05};
  double guess = 0.5;
  double drift_db = 0.0;
  std::vector<double> levels{};  ///< empty: those of usual_track
};

Observer observer_of(const Kind& kind, std::size_t run) {
  RandomStream random(run, "table/observer");
  Observer observer;
  observer.shape = kind.shape;
  observer.threshold = random.uniform(kind.threshold.low, kind.threshold.high);
  observer.slope = std::exp(random.uniform(std::log(kind.slope.low), std::log(kind.slope.high)));
  observer.lapse = random.uniform(kind.lapse.low, kind.lapse.high);
  observer.guess = kind.guess;
  return observer;
}

/// Where an observer of this shape without lapses would be right as often as a Weibull observer at
/// the threshold.
double truth_of(Observer observer) {
  if (observer.shape == Shape::weibull) return observer.threshold;
  observer.lapse = 0.0;
  return level_at(observer, std::lerp(observer.guess, 1.0, share_at_threshold(Shape::weibull)));
}

/// One observer's answers to a procedure.
struct AnsweredTrack {
  Observer observer;
  std::vector<TrackTrial> trials;
};

/// Tracks of one procedure, each of another observer.
struct Tracks {
  TrackSettings settings;
  std::vector<AnsweredTrack> each;
};

Tracks tracks_of(const Kind& kind, const std::string& procedure, int trials, int runs) {
  Tracks tracks{usual_track(procedure, trials),
                std::vector<AnsweredTrack>(static_cast<std::size_t>(runs))};
  if (!kind.levels.empty()) tracks.settings.levels = kind.levels;
  tracks.settings.grid.guess = kind.guess;
  in_parallel(0, tracks.each.size(), [&](std::size_t run) {
    const Observer observer = observer_of(kind, run);
    tracks.each[run] = {observer, answered_track(tracks.settings, observer, run, kind.drift_db)};
  });
  return tracks;
}

/// \param trials        the first ones of each track; all, if there are not more
/// \param by_reversals  a staircase's mean of reversals in place of the estimate
std::vector<Outcome> outcomes_of(const Tracks& tracks, int trials, bool by_reversals = false) {
  TrackSettings settings = tracks.settings;
  settings.trials = std::min(settings.trials, trials);
  std::vector<Outcome> all(tracks.each.size());
  in_parallel(0, all.size(), [&](std::size_t run) {
    const auto& [observer, answered] = tracks.each[run];
    const std::span<const TrackTrial> answers =
        std::span(answered).first(static_cast<std::size_t>(settings.trials));
    if (by_reversals) {
      all[run] = {reversal_threshold(settings.levels, answers),
                  level_at(observer, convergence_of(settings.up_down))};
    } else {
      all[run] = {estimate_of(settings, answers, observer, run).threshold, truth_of(observer)};
    }
  });
  return all;
}

bool holds(const Threshold& found, double truth) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  return found.low.value_or(-kOpen) <= truth && truth <= found.high.value_or(kOpen);
}

std::string share_text(double count, double of) {
  return of > 0.0 ? fmt::format("{:.3f}", count / of) : "-";
}

/// As kFigures has them.
std::string figures_of(const std::vector<Outcome>& all, bool has_interval = true) {
  double quoted = 0.0, sum = 0.0, squares = 0.0, covered = 0.0, quoted_covered = 0.0;
  double closed = 0.0, width = 0.0;
  for (const Outcome& one : all) {
    const bool held = holds(one.threshold, one.truth);
    covered += held ? 1.0 : 0.0;
    if (!one.threshold.level) continue;
    const double error = *one.threshold.level - one.truth;
    quoted += 1.0;
    sum += error;
    squares += error * error;
    if (!has_interval) continue;
    quoted_covered += held ? 1.0 : 0.0;
    if (!one.threshold.low || !one.threshold.high) continue;
    closed += 1.0;
    width += *one.threshold.high - *one.threshold.low;
  }
  const auto runs = static_cast<double>(all.size());
  const std::string errors = 10.0 * quoted > runs ? fmt::format("{:+.2f} | {:.2f}", sum / quoted,
                                                                std::sqrt(squares / quoted))
                                                  : "- | -";
  if (!has_interval) {
    return fmt::format("{} | {} | - | - | - | -", share_text(quoted, runs), errors);
  }
  const std::string of_quoted =
      10.0 * quoted > runs ? fmt::format("{} | {} | {:.1f}", share_text(quoted_covered, quoted),
                                         share_text(closed, quoted), width / closed)
                           : "- | - | -";
  return fmt::format("{} | {} | {} | {}", share_text(quoted, runs), errors,
                     share_text(covered, runs), of_quoted);
}

constexpr const char* kFigures = "quoted | bias | RMSE | coverage | of quoted | closed | width";

void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

void print_procedures(int runs) {
  constexpr std::array kNames{"up-down",      "weighted-up-down",       "quest-plus",
                              "psi-marginal", "psi-marginal-threshold", "constant-stimuli"};
  print_line(fmt::format("| procedure | trials | estimate | {} |", kFigures));
  print_line("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
  std::vector<Tracks> tracks;
  for (const char* name : kNames) tracks.push_back(tracks_of({}, name, 120, runs));
  for (const int trials : {30, 60, 120}) {
    for (const Tracks& of : tracks) {
      const std::string& name = of.settings.procedure;
      const auto print = [&](const char* words, bool by_reversals) {
        print_line(fmt::format("| {} | {} | {} | {} |", name, trials, words,
                               figures_of(outcomes_of(of, trials, by_reversals), !by_reversals)));
      };
      if (name.ends_with("up-down")) print("reversals", true);
      print("threshold", false);
    }
  }
}

/// Observers whom no grid of a procedure holds.
std::vector<Kind> unassumed_kinds() {
  std::vector<Kind> kinds;
  for (const double lapse : {0.0, 0.05, 0.1, 0.15, 0.2}) {
    kinds.push_back({.words = fmt::format("lapse rate {:.2f}", lapse), .lapse = {lapse, lapse}});
  }
  for (const double slope : {1.17, 2.0, 3.5, 6.0, 10.5}) {
    kinds.push_back({.words = fmt::format("slope {}", slope), .slope = {slope, slope}});
  }
  kinds.push_back({.words = "logistic function", .shape = Shape::logistic, .slope = {0.25, 0.75}});
  kinds.push_back({.words = "threshold -40 .. -34 dB", .threshold = {-40.0, -34.0}});
  kinds.push_back({.words = "threshold -6 .. 0 dB", .threshold = {-6.0, 0.0}});
  kinds.push_back({.words = "threshold -60 .. -40 dB", .threshold = {-60.0, -40.0}});
  kinds.push_back({.words = "threshold 0 .. 20 dB", .threshold = {0.0, 20.0}});
  kinds.push_back({.words = "rises by 6 dB", .drift_db = 6.0});
  kinds.push_back({.words = "falls by 6 dB", .drift_db = -6.0});
  kinds.push_back({.words = "three intervals", .guess = 1.0 / 3.0});
  return kinds;
}

void print_unassumed(int runs) {
  print_line(fmt::format("| observers | procedure | {} |", kFigures));
  print_line("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
  constexpr int kTrials = 60;
  const auto print = [&](const Kind& kind, const char* procedure) {
    const Tracks tracks = tracks_of(kind, procedure, kTrials, runs);
    print_line(fmt::format("| {} | {} | {} |", kind.words, procedure,
                           figures_of(outcomes_of(tracks, kTrials))));
  };
  for (const Kind& kind : unassumed_kinds()) {
    for (const char* procedure :
         {"quest-plus", "weighted-up-down", "up-down", "constant-stimuli"}) {
      print(kind, procedure);
    }
  }
  print({.words = "unequal levels", .levels = {-40, -33, -28, -24, -21, -19, -17, -14, -11, -6, 0}},
        "quest-plus");
  print({.words = "levels 5 dB apart", .levels = decibels(-40, 0, 5)}, "quest-plus");
  print({.words = "threshold -6 .. 0 dB, slope 1.17",
         .threshold = {-6.0, 0.0},
         .slope = {1.17, 1.17}},
        "quest-plus");
  print({.words = "threshold -40 .. -34 dB, lapse rate 0.10",
         .threshold = {-40.0, -34.0},
         .lapse = {0.1, 0.1}},
        "quest-plus");
}

/// QUEST+ with those for whom 60 trials are too few.
void print_lengths(int runs) {
  print_line(fmt::format("| observers | trials | {} |", kFigures));
  print_line("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
  const std::vector<Kind> kinds = unassumed_kinds();
  for (const char* words : {"lapse rate 0.10", "lapse rate 0.15", "lapse rate 0.20", "slope 1.17",
                            "threshold -40 .. -34 dB"}) {
    const Kind& kind = *std::ranges::find(kinds, words, &Kind::words);
    const Tracks tracks = tracks_of(kind, "quest-plus", 120, runs);
    for (const int trials : {60, 90, 120}) {
      print_line(
          fmt::format("| {} | {} | {} |", words, trials, figures_of(outcomes_of(tracks, trials))));
    }
  }
}

void print_without_threshold(int runs) {
  constexpr double kNowhere_db = 300.0;
  print_line("| observers | constant stimuli, 30 | QUEST+, 10 | QUEST+, 30 | QUEST+, 60 |");
  print_line("| --- | --- | --- | --- | --- |");
  std::vector<Kind> kinds{
      {.words = "guess, two intervals", .threshold = {kNowhere_db, kNowhere_db}},
      {.words = "guess, three intervals",
       .threshold = {kNowhere_db, kNowhere_db},
       .guess = 1.0 / 3.0}};
  for (const double lapse : {0.0, 0.02, 0.05, 0.1}) {
    kinds.push_back({.words = fmt::format("right but for {:.2f}", lapse),
                     .threshold = {-kNowhere_db, -kNowhere_db},
                     .lapse = {lapse, lapse}});
  }
  for (const Kind& kind : kinds) {
    std::string line = "| " + kind.words + " |";
    const auto add = [&](const Tracks& tracks, int trials) {
      double quoted = 0.0;
      for (const Outcome& one : outcomes_of(tracks, trials)) {
        quoted += one.threshold.level ? 1.0 : 0.0;
      }
      line += fmt::format(" {:.3f} |", quoted / runs);
    };
    add(tracks_of(kind, "constant-stimuli", 30, runs), 30);
    const Tracks adaptive = tracks_of(kind, "quest-plus", 60, runs);
    for (const int trials : {10, 30, 60}) add(adaptive, trials);
    print_line(line);
  }
}

void print_goodness_of_fit(int runs) {
  runs = std::min(runs, 400);
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
      shape, options.lapse ? fmt::format("{}", *options.lapse) : "null", options.max_lapse,
      counts_json(counts), fit.observer.threshold, fit.observer.slope, fit.observer.lapse,
      fit.log_likelihood, fit.deviance);
}

std::string number_json(const std::optional<double>& number) {
  return number ? fmt::format("{:.17g}", *number) : "null";
}

void print_estimate(const char* shape, const std::vector<LevelCounts>& counts,
                    const std::vector<double>& levels, double guess, const Threshold& found) {
  constexpr std::array kWords{"no", "below", "above", "undetermined"};
  fmt::print(
      "{{\"shape\": \"{}\", \"guess\": {:.17g}, \"levels\": [{}], \"counts\": {}, "
      "\"estimate\": {{\"level\": {}, \"low\": {}, \"high\": {}, \"censored\": \"{}\"}}}}\n",
      shape, guess, fmt::join(levels, ", "), counts_json(counts), number_json(found.level),
      number_json(found.low), number_json(found.high),
      kWords[static_cast<std::size_t>(found.censored)]);
}

/// Every shape, with lapses free and without, for tracks of constant stimuli and adaptive ones;
/// then estimates of observers of every kind.
int print_fits(int tracks) {
  constexpr std::array kShapes{std::pair{"weibull", Shape::weibull},
                               std::pair{"logistic", Shape::logistic},
                               std::pair{"normal", Shape::normal}};
  for (int track = 0; track < tracks; ++track) {
    const auto seed = static_cast<std::uint64_t>(track);
    const TrackSettings settings =
        usual_track(track % 2 == 0 ? "constant-stimuli" : "quest-plus", track % 2 == 0 ? 240 : 60);
    const std::vector<LevelCounts> counts =
        counts_of(settings.levels, answered_track(settings, some_observer(seed), seed));
    for (const auto& [name, shape] : kShapes) {
      print_fit(name, counts, {.shape = shape});
      print_fit(name, counts, {.shape = shape, .lapse = 0.0});
    }
  }
  const std::vector<Kind> kinds = unassumed_kinds();
  for (int track = 0; track < tracks; ++track) {
    const auto seed = static_cast<std::size_t>(track);
    const Kind& kind = kinds[seed % kinds.size()];
    const Observer observer = observer_of(kind, seed);
    TrackSettings settings = usual_track(track % 2 == 0 ? "quest-plus" : "constant-stimuli", 60);
    settings.grid.guess = kind.guess;
    const std::vector<LevelCounts> counts =
        counts_of(settings.levels, answered_track(settings, observer, seed, kind.drift_db));
    for (const auto& [name, shape] : kShapes) {
      print_estimate(name, counts, settings.levels, kind.guess,
                     estimate_threshold(counts, settings.levels, shape, kind.guess).threshold);
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
      "`scripts/recovery-procedures {0}` prints these tables. Each row has {0} observers, "
      "each with one track and, at the\n"
      "highest level, a tenth as many trials again (at least six). Unless a row states "
      "otherwise: Weibull functions in dB,\n"
      "guess .5, thresholds uniform in -24 .. -14 dB, slopes log-uniform in 2 .. 6, lapse "
      "rates uniform in 0 .. .05. Settings\n"
      "are in [thresholds.md](thresholds.md#defaults); staircases begin at -10 dB; constant "
      "stimuli are at -30, -25 .. -5 dB.\n\n"
      "- *Quoted*: share of the tracks with a number. *Bias*, *RMSE*: of these, in dB.\n"
      "- *Coverage*: share of all tracks whose interval contains the true value, including "
      "open intervals; *of quoted*: of\n"
      "  tracks with a number (Monte-Carlo error {1:.3f}).\n"
      "- *Closed*: share of tracks with a number whose interval is closed on both sides; "
      "*width*: its mean width in dB.\n\n"
      "If less than a tenth is quoted, only *quoted* and *coverage* are given.\n\n"
      "## Procedures\n\n"
      "![Error and coverage of every procedure after 30, 60 and 120 "
      "trials](images/procedures-recovery.svg)\n\n"
      "(`scripts/recovery-procedures figure` draws it from this table.) Means of reversals "
      "estimate the point of convergence.\n\n",
      runs, std::sqrt(0.95 * 0.05 / runs));
  print_procedures(runs);
  fmt::print(
      "\n## Observers outside the assumptions\n\n"
      "Tracks have 60 trials. The procedure's own grid has slopes of 1 to 8 and lapse rates "
      "of 0 to .2. The true threshold of\n"
      "a logistic function is the level with the same proportion correct as at a Weibull "
      "function's threshold; that of a moving\n"
      "threshold is its mean over the track.\n\n");
  print_unassumed(runs);
  fmt::print(
      "\n## How many trials\n\n"
      "QUEST+ with observers for whom 60 trials are few.\n\n");
  print_lengths(runs);
  fmt::print(
      "\n## Observers without a threshold\n\n"
      "The share of tracks with a number, by procedure and trials.\n\n");
  print_without_threshold(runs);
  fmt::print("\n## Goodness of fit\n");
  print_goodness_of_fit(runs);
}
