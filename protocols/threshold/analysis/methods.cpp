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
using study::threshold::Along;
using study::threshold::Question;
using study::threshold::Task;
using study::threshold::ThresholdOptions;

std::string plane_words(const ThresholdOptions& options) {
  if (options.task == Task::detection) {
    return options.intervals == 2 ? "one plane had the texture, the other none"
                                  : "one plane had the texture, the others none";
  }
  static constexpr auto kWords =
      std::to_array<Named<Along>>({{"by the gain of its forces", Along::gain},
                                   {"by its pitch, in millimetres per pixel", Along::pitch},
                                   {"by its order of differentiation", Along::order},
                                   {"by the share of a second texture", Along::blend}});
  return "a comparison differed from a standard " + std::string(name_in(kWords, options.along));
}

std::string asked_words(const ThresholdOptions& options) {
  switch (options.question) {
    case Question::odd_one_out:
      return "which of the three was unlike the other two; either kind was the odd one equally "
             "often";
    case Question::same_different:
      return "whether the two were alike, as they were in half of the trials";
    case Question::which_interval:
      break;
  }
  const std::string drawn = "; its place was drawn in each trial";
  if (options.task == Task::detection) return "which plane had the texture" + drawn;
  return (options.along == Along::pitch ? "which plane was coarser" : "which plane felt stronger") +
         drawn;
}

/// "from -40 to 0 in steps of 1 dB", or all of them.
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

/// What A is, where levels are 20 log10(ΔA / A).
std::string amplitude_words(Along along) {
  static constexpr auto kWords = std::to_array<Named<Along>>(
      {{"the standard's gain (stated in dB re the gain of the stimuli)", Along::gain},
       {"the standard's pitch", Along::pitch},
       {"the standard's order", Along::order},
       {"1 and ΔA the share of the second texture", Along::blend}});
  return std::string(name_in(kWords, along));
}

std::string level_sentence(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  std::string text = "Levels were gains in dB re the gain of the stimuli";
  if (options.task == Task::discrimination) {
    text = "Levels were 20 log10(ΔA / A) in dB, with A " + amplitude_words(options.along);
    if (options.along != Along::blend) text += " and ΔA the comparison's value less A";
  }
  std::vector<std::string> of_standards;
  bool are_equal = true;
  for (const study::threshold::Standard& one : study::threshold::standards_of(report.design)) {
    const std::vector<double> levels = study::threshold::levels_of(options, one);
    are_equal = are_equal && levels == options.track.levels;
    of_standards.push_back(values_words(levels) + " dB for " +
                           study::threshold::words_of(report.design, one));
  }
  text += are_equal ? ", of " + values_words(options.track.levels) + " dB"
                    : fmt::format(
                          "; without those of which a comparison could be above the "
                          "stimuli's gain there were {}",
                          fmt::join(of_standards, "; "));
  return text + ". All planes, with and without texture, had the same mean height.";
}

std::string standards_sentence(const ThresholdReport& report) {
  if (report.options().task == Task::detection && report.standards.size() < 2) return {};
  std::vector<std::string> words;
  for (const study::threshold::Standard& one : study::threshold::standards_of(report.design)) {
    words.push_back(study::threshold::words_of(report.design, one));
  }
  return fmt::format("Thresholds were measured for {}.", fmt::join(words, "; "));
}

std::string staircase_words(const TrackSettings& track) {
  const procedures::UpDown& rule = track.up_down;
  return fmt::format(
      "the level went down after {} and up after {}, by {} places of the list of levels at first "
      "and after each reversal (a step up being {}), from {} dB on; it converges to {:.1f} % right",
      counted(rule.correct_for_down, "right answer"), counted(rule.wrong_for_up, "wrong answer"),
      listed(rule.steps_down, ", ", [](int step) { return std::to_string(step); }),
      counted(rule.up_for_one_down, "step down"), number_text(track.levels[rule.first_level]),
      100.0 * procedures::convergence_of(rule));
}

std::string prior_words(const std::vector<double>& prior) {
  return prior.empty() ? "" : ", with weights of its own";
}

/// The name of a function F and its formula.
std::string shape_words(procedures::Shape shape) {
  switch (shape) {
    case procedures::Shape::weibull:
      return "Weibull functions, F(x) = 1 − exp(−10^(β (x − t) / 20)),";
    case procedures::Shape::logistic:
      return "logistic functions, F(x) = 1 / (1 + exp(−β (x − t))),";
    case procedures::Shape::normal:
      return "cumulative normal functions, F(x) = Φ(β (x − t)),";
  }
  return {};
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

/// Whether the procedure has beliefs on a grid, which grid_words describes.
bool has_grid(const TrackSettings& track) {
  return track.procedure == "quest-plus" || track.procedure.starts_with("psi");
}

Cited procedure_sentence(const ThresholdOptions& options) {
  const TrackSettings& track = options.track;
  const std::string trials = counted(track.trials, "trial") + " a track";
  if (track.procedure == "constant-stimuli") {
    return {fmt::format("Levels were constant stimuli: each came equally often in {}, {}.", trials,
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
  const ProcedureWords kinds[] = {
      {"quest-plus",
       "QUEST+, the least expected entropy of threshold, slope and lapse rate",
       {Source::watson}},
      {"psi",
       "the psi method, the least expected entropy of threshold, slope and lapse rate",
       {Source::kontsevich_tyler}},
      {"psi-marginal",
       "the psi-marginal method, the least expected entropy of threshold and slope",
       {Source::prins}},
      {"psi-marginal-threshold",
       "the psi-marginal method, the least expected entropy of the threshold",
       {Source::prins}}};
  for (const ProcedureWords& kind : kinds) {
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
  return fmt::format("{} tracks were interleaved: each came once in every round, in random order.",
                     tracks);
}

std::string catch_sentence(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  if (options.catch_trials == 0) return {};
  return fmt::format(
      "There were {} at the highest level{}, at random places among the others; the procedure did "
      "not use them, but the estimate counts them.",
      counted(options.catch_trials, "catch trial"),
      number_of_tracks(report) > 1 ? ", dealt evenly to the tracks" : "");
}

std::string repeated_sentence() {
  return "The repetition of a trial had the same level and a right answer that was drawn anew.";
}

std::string rove_sentence(const ThresholdOptions& options) {
  if (options.rove_db == 0.0) return {};
  return fmt::format(
      "The gain of each textured plane was drawn from a range of {} dB {}.",
      number_text(options.rove_db),
      options.along == Along::gain ? "about its level" : "that ended at the stimulus's gain");
}

std::string control_sentence(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  if (options.control_trials == 0) return {};
  return fmt::format(
      "At the end came {} with the hand off the device, to show whether the answer could be heard: "
      "the device played the lateral forces of a circular stroke at {:g} mm/s under {:g} N, at the "
      "highest level{}, and for {} s a plane.",
      counted(options.control_trials, "trial"), study::kPlayedMmS, study::kPlayedLoadN,
      study::threshold::standards_of(report.design).size() > 1 ? " of a standard" : "",
      number_text(options.interval_s));
}

void add_estimates(const ThresholdReport& report, Sentences& all) {
  if (!report.has_thresholds()) {
    all.push_back(
        {"d′ was computed for each level by the differencing model, of the answers of "
         "all participants, with a bootstrap interval over participants.",
         {Source::davison_hinkley, Source::hesterberg}});
    return;
  }
  all.push_back(
      {fmt::format("A threshold is the level with {:.1f} % right, of an observer without lapses.",
                   100.0 * *report.criterion)});
  const TrackSettings& track = report.options().track;
  all.push_back({fmt::format(
      "It was estimated from the numbers of right answers at each level, catch trials included, by "
      "{}. Its 95 % interval holds the thresholds that a likelihood-ratio test (χ², one degree of "
      "freedom) does not reject, with likelihoods averaged over widths w (F from 0.05 to 0.95) of "
      "{:g} to {:g} dB with a density in proportion to w^{:g}, and over lapse rates up to {:g} "
      "with that of Beta(1, {:g}). Its value is the most likely one in that interval if widths are "
      "log-normal (median {:g} dB, SD {:g} of the natural logarithm) and lapse rates Beta(1, "
      "{:g}).",
      has_grid(track) ? std::string("the same function F, not by the procedure's posterior")
                      : fmt::format("{} p = γ + (1 − γ − λ) F(x) and γ = {:.3g}",
                                    shape_words(track.grid.shape), track.grid.guess),
      procedures::kMinWidth_db, procedures::kMaxWidth_db, procedures::kWidthPower,
      procedures::kMaxLapse, procedures::kAnyLapse, procedures::kTypicalWidth_db,
      procedures::kTypicalSpread, procedures::kTypicalLapse)});
  all.push_back(
      {"A track has a threshold only if that value lies within the levels and the test rejects "
       "that all levels are felt and that none is."});
  all.push_back(
      {"Participants with a threshold beyond the levels count by that bound: the mean is "
       "that of the normal distribution most likely for all, with an interval by "
       "likelihood ratio, which is Student's if all thresholds are known.",
       {Source::tobin, Source::student}});
  if (!report.differences.empty()) {
    all.push_back({"Standards were compared in pairs in the same way, adjusted by Holm's method.",
                   {Source::holm}});
  }
  const bool has_fits = std::ranges::any_of(
      report.tracks, [](const TrackReport& one) { return one.fit.has_value(); });
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
                   options.intervals, plane_words(options), asked_words(options))}};
  methods.sequence = {{standards_sentence(report)}, {level_sentence(report)},
                      procedure_sentence(options),  {tracks_sentence(report)},
                      {catch_sentence(report)},     {repeated_sentence()},
                      {rove_sentence(options)},     {control_sentence(report)}};
  add_estimates(report, methods.statistics);
  if (report.control) {
    methods.statistics.push_back(
        {"Right answers with the hand off the device were tested against guessing by exact "
         "binomial tests, one-sided, adjusted by Holm's method.",
         {Source::clopper_pearson, Source::holm}});
  }
  return methods;
}

}  // namespace touchtrial::analysis::threshold
