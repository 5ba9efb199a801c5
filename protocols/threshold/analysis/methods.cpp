#include "protocols/threshold/analysis/methods.hpp"

#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "protocols/procedures/estimates.hpp"
#include "study/ask.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::analysis::threshold {
namespace {

using procedures::ParameterGrid;
using procedures::TrackSettings;
using study::threshold::LevelQuantity;
using study::threshold::Question;
using study::threshold::Task;
using study::threshold::ThresholdOptions;

std::string plane_words(const ThresholdOptions& options) {
  if (options.task == Task::detection) {
    return options.intervals == 2 ? "one plane had the texture, the other none"
                                  : "one plane had the texture, the others none";
  }
  static constexpr auto kWords = std::to_array<Named<LevelQuantity>>(
      {{"by the gain of its forces", LevelQuantity::gain},
       {"by its pitch, in millimetres per pixel", LevelQuantity::pitch},
       {"by its order of differentiation", LevelQuantity::order},
       {"by the share of a second texture", LevelQuantity::blend}});
  return "a comparison differed from a standard " + std::string(name_in(kWords, options.along));
}

std::string question_words(const ThresholdOptions& options) {
  switch (options.question) {
    case Question::odd_one_out:
      return "which of the three differed from the other two; both kinds were the odd one equally "
             "often";
    case Question::same_different:
      return "whether the two were the same, as in half of the trials";
    case Question::which_interval:
      break;
  }
  const std::string place_words = "; its place was drawn in each trial";
  if (options.task == Task::detection) return "which plane had the texture" + place_words;
  return (options.along == LevelQuantity::pitch ? "which plane was coarser"
                                                : "which plane felt stronger") +
         place_words;
}

/// "-40 to 0 in steps of 1", or the listed values.
std::string values_words(const std::vector<double>& values) {
  if (values.size() == 1) return number_text(values.front());
  const double step = values[1] - values[0];
  const bool is_even =
      values.size() > 3 && std::ranges::adjacent_find(values, [&](double a, double b) {
                             return std::abs(b - a - step) > 1e-9;
                           }) == values.end();
  if (!is_even) return listed(values, " and ", number_text);
  return fmt::format("{:g} to {:g} in steps of {:g}", values.front(), values.back(), step);
}

/// The words for A in the levels 20 log10(ΔA / A).
std::string amplitude_words(LevelQuantity along) {
  static constexpr auto kWords = std::to_array<Named<LevelQuantity>>(
      {{"the standard's gain (stated in dB re the gain of the stimuli)", LevelQuantity::gain},
       {"the standard's pitch", LevelQuantity::pitch},
       {"the standard's order", LevelQuantity::order},
       {"1 and ΔA the share of the second texture", LevelQuantity::blend}});
  return std::string(name_in(kWords, along));
}

std::string level_sentence(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  std::string text = "Levels were gains in dB re the gain of the stimuli";
  if (options.task == Task::discrimination) {
    text = "Levels were 20 log10(ΔA / A) in dB, with A " + amplitude_words(options.along);
    if (options.along != LevelQuantity::blend) text += " and ΔA the comparison's value minus A";
  }
  std::vector<std::string> levels_by_standard;
  bool are_equal = true;
  for (const study::threshold::Standard& standard : study::threshold::standards_of(report.design)) {
    const std::vector<double> levels = study::threshold::levels_of(options, standard);
    are_equal = are_equal && levels == options.track.levels;
    levels_by_standard.push_back(values_words(levels) + " dB for " +
                                 study::threshold::words_of(report.design, standard));
  }
  text += are_equal ? ", of " + values_words(options.track.levels) + " dB"
                    : fmt::format(
                          "; without those at which a comparison could exceed the stimuli's "
                          "gain they were {}",
                          fmt::join(levels_by_standard, "; "));
  return text + ". All planes, with and without texture, had the same mean height.";
}

std::string standards_sentence(const ThresholdReport& report) {
  if (report.options().task == Task::detection && report.standards.size() < 2) return {};
  std::vector<std::string> words;
  for (const study::threshold::Standard& standard : study::threshold::standards_of(report.design)) {
    words.push_back(study::threshold::words_of(report.design, standard));
  }
  return fmt::format("Thresholds were measured for {}.", fmt::join(words, "; "));
}

std::string staircase_words(const TrackSettings& track) {
  const procedures::UpDown& rule = track.up_down;
  return fmt::format(
      "the level went down after {} and up after {}, by {} places of the list of levels at first "
      "and after each reversal (one step up being {}), from {} dB; it converges to {:.1f}% right",
      counted(rule.correct_for_down, "right answer"), counted(rule.wrong_for_up, "wrong answer"),
      listed(rule.steps_down, ", ", [](int step) { return std::to_string(step); }),
      counted(rule.up_for_one_down, "step down"), number_text(track.levels[rule.first_level]),
      100.0 * procedures::convergence_of(rule));
}

std::string prior_words(const std::vector<double>& prior) {
  return prior.empty() ? "" : ", with unequal prior weights";
}

/// The name of a function F and its formula.
std::string_view shape_words(procedures::Shape shape) {
  using enum procedures::Shape;
  static constexpr auto kWords = std::to_array<Named<procedures::Shape>>(
      {{"Weibull functions, F(x) = 1 − exp(−10^(β (x − t) / 20)),", weibull},
       {"logistic functions, F(x) = 1 / (1 + exp(−β (x − t))),", logistic},
       {"cumulative normal functions, F(x) = Φ(β (x − t)),", normal}});
  return name_in(kWords, shape);
}

std::string grid_words(const ParameterGrid& grid) {
  const bool is_flat =
      grid.threshold_prior.empty() && grid.slope_prior.empty() && grid.lapse_prior.empty();
  return fmt::format(
      "observers who are right at level x with probability γ + (1 − γ − λ) F(x): {} with "
      "thresholds t of {} dB{}, slopes β of {}{}, lapse rates λ of {}{} and a guess rate γ of "
      "{:.3g}{}",
      shape_words(grid.shape), values_words(grid.thresholds), prior_words(grid.threshold_prior),
      values_words(grid.slopes), prior_words(grid.slope_prior), values_words(grid.lapses),
      prior_words(grid.lapse_prior), grid.guess,
      is_flat ? ", all equally likely before the first trial" : "");
}

struct ProcedureWords {
  std::string_view name;
  const char* title;
  std::vector<Source> sources;
};

/// Whether the procedure has a posterior on the grid.
bool has_grid(const TrackSettings& track) {
  return track.procedure == "quest-plus" || track.procedure.starts_with("psi");
}

CitedText procedure_sentence(const ThresholdOptions& options) {
  const TrackSettings& track = options.track;
  const std::string trials = counted(track.trials, "trial") + " per track";
  if (track.procedure == "constant-stimuli") {
    return {fmt::format("Levels were constant stimuli: each occurred equally often in {}, {}.",
                        trials,
                        track.blocked ? "all trials of a level together, in random order of levels"
                                      : "once before any was repeated, in random order")};
  }
  if (track.procedure == "up-down") {
    return {fmt::format("The level of each trial followed a transformed staircase of {}: {}.",
                        trials, staircase_words(track)),
            {Source::levitt}};
  }
  if (track.procedure == "weighted-up-down") {
    return {fmt::format("The level of each trial followed a weighted staircase of {}: {}.", trials,
                        staircase_words(track)),
            {Source::kaernbach}};
  }
  const ProcedureWords adaptive_procedures[] = {
      {"quest-plus",
       "QUEST+, minimising the expected entropy of threshold, slope and lapse rate",
       {Source::watson}},
      {"psi",
       "the psi method, minimising the expected entropy of threshold, slope and lapse rate",
       {Source::kontsevich_tyler}},
      {"psi-marginal",
       "the psi-marginal method, minimising the expected entropy of threshold and slope",
       {Source::prins}},
      {"psi-marginal-threshold",
       "the psi-marginal method, minimising the expected entropy of the threshold",
       {Source::prins}}};
  for (const ProcedureWords& kind : adaptive_procedures) {
    if (kind.name != track.procedure) continue;
    return {fmt::format("The level of each trial was chosen by {}, in {}, over {}.", kind.title,
                        trials, grid_words(track.grid)),
            kind.sources};
  }
  return {fmt::format("The level of each trial was chosen by {}, in {}.", track.procedure, trials)};
}

std::size_t number_of_tracks(const ThresholdReport& report) {
  return study::threshold::standards_of(report.design).size() *
         static_cast<std::size_t>(report.options().tracks_each);
}

std::string tracks_sentence(const ThresholdReport& report) {
  const std::size_t tracks = number_of_tracks(report);
  if (tracks < 2) return {};
  return fmt::format("{} tracks were interleaved, each once per round in random order.", tracks);
}

std::string catch_sentence(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  if (options.catch_trials == 0) return {};
  return fmt::format(
      "There were {} at the highest level{}, at random places; the procedure ignored them, but the "
      "estimate includes them.",
      counted(options.catch_trials, "catch trial"),
      number_of_tracks(report) > 1 ? ", divided evenly among the tracks" : "");
}

std::string rove_sentence(const ThresholdOptions& options) {
  if (options.rove_db == 0.0) return {};
  return fmt::format("The gain of each textured plane was drawn from a range of {} dB {}.",
                     number_text(options.rove_db),
                     options.along == LevelQuantity::gain ? "about its level"
                                                          : "that ended at the stimulus's gain");
}

std::string control_sentence(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  if (options.control_trials == 0) return {};
  return fmt::format(
      "At the end there were {} with the hand off the device, to test whether the answer could be "
      "heard: the device played the lateral forces of a circular stroke at {:g} mm/s under {:g} N, "
      "at the highest level{}, for {} s per plane.",
      counted(options.control_trials, "trial"), study::kPlayedMmS, study::kPlayedLoadN,
      study::threshold::standards_of(report.design).size() > 1 ? " of a standard" : "",
      number_text(options.interval_s));
}

void add_estimates(const ThresholdReport& report, Sentences& all) {
  if (!report.has_thresholds()) {
    all.push_back(
        {"d′ was computed for each level by the differencing model, from the answers of all "
         "participants, with a bootstrap interval over participants.",
         {Source::davison_hinkley, Source::hesterberg}});
    return;
  }
  all.push_back(
      {fmt::format("A threshold is the level with {:.1f}% right for an observer without lapses.",
                   100.0 * *report.criterion)});
  const TrackSettings& track = report.options().track;
  all.push_back({fmt::format(
      "It was estimated from the numbers of right answers at each level, including catch trials, "
      "by {}. Its 95% interval contains the thresholds that a likelihood-ratio test (χ², one "
      "degree of freedom) does not reject, with likelihoods averaged over widths w (F from 0.05 to "
      "0.95) of {:g} to {:g} dB with a density proportional to w^{:g}, and over lapse rates up to "
      "{:g} with the density Beta(1, {:g}). Its value is the most likely one in this interval if "
      "widths are log-normal (median {:g} dB, SD {:g} of the natural logarithm) and lapse rates "
      "Beta(1, {:g}).",
      has_grid(track) ? std::string("the same function F, not by the procedure's posterior")
                      : fmt::format("{} p = γ + (1 − γ − λ) F(x) and γ = {:.3g}",
                                    shape_words(track.grid.shape), track.grid.guess),
      procedures::kMinWidth_db, procedures::kMaxWidth_db, procedures::kWidthPower,
      procedures::kMaxLapse, procedures::kLapseBeta, procedures::kTypicalWidth_db,
      procedures::kTypicalSpread, procedures::kTypicalLapseBeta)});
  all.push_back(
      {"A track has a threshold only if this value is within the levels, and the test rejects that "
       "all levels are felt and that none is."});
  all.push_back(
      {"Thresholds beyond the levels are censored: the mean is the maximum-likelihood mean of a "
       "normal distribution, with a likelihood-ratio interval, which is Student's if all "
       "thresholds are known.",
       {Source::tobin, Source::student}});
  if (!report.differences.empty()) {
    all.push_back({"Standards were compared in pairs in the same way, adjusted by Holm's method.",
                   {Source::holm}});
  }
  const bool has_fits = std::ranges::any_of(
      report.tracks, [](const TrackReport& entry) { return entry.fit.has_value(); });
  if (has_fits) {
    all.push_back(
        {"Goodness of fit was tested by the deviance of simulated data.", {Source::wichmann_hill}});
  }
}

}  // namespace

ProtocolMethods protocol_methods(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  ProtocolMethods methods;
  methods.trial = {
      {fmt::format("In each trial {} planes were felt one after the other; {}, and participants "
                   "answered {}.",
                   options.intervals, plane_words(options), question_words(options))}};
  methods.sequence = {
      {standards_sentence(report)},
      {level_sentence(report)},
      procedure_sentence(options),
      {tracks_sentence(report)},
      {catch_sentence(report)},
      {"The repetition of a trial had the same level and a newly drawn right answer."},
      {rove_sentence(options)},
      {control_sentence(report)}};
  add_estimates(report, methods.statistics);
  if (report.control) {
    methods.statistics.push_back(
        {"Right answers with the hand off the device were tested against guessing by one-sided "
         "exact binomial tests, adjusted by Holm's method.",
         {Source::clopper_pearson, Source::holm}});
  }
  return methods;
}

}  // namespace touchtrial::analysis::threshold
