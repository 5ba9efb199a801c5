/// \file Thresholds of finished tracks, with intervals, and how well a function fits. A threshold that
/// answers do not place inside the levels is censored: it has a side or bounds, and no number.
/// Formulas and sources: docs/thresholds.md, "Estimates".
#pragma once

#include "core/random.hpp"
#include "protocols/procedures/psychometric_function.hpp"
#include "protocols/procedures/tracks.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::procedures {

/// What is known of a threshold that has no number.
enum class Censored {
  no,            ///< it has one
  below,         ///< it lies below the levels
  above,         ///< it lies above the levels
  undetermined,  ///< the answers tell neither a number nor a side
};

/// A threshold and its interval, in units of the level.
struct Threshold {
  std::optional<double> level;  ///< only if `censored` is no
  std::optional<double> low;    ///< nothing: the interval is open on this side, or there is none
  std::optional<double> high;
  Censored censored = Censored::no;
};

/// Levels of a staircase's turns, in order: a level that is higher, or lower, than the levels
/// before and after it.
[[nodiscard]] std::vector<std::size_t> reversals_of(std::span<const TrackTrial> trials);

/// The mean level of the last reversals, an even number of them, for the point convergence_of().
/// Biased: by the size of the last steps, and in short tracks towards the first level
/// (docs/procedures-recovery.md has the bias found). No interval.
/// \param skipped  reversals at the start that do not count, >= 0
/// \return no level with fewer than two reversals; censored if a counted reversal, or without
///   reversals the last trial, is at a bound
/// \throws std::invalid_argument if there are no trials or levels
[[nodiscard]] Threshold reversal_threshold(std::span<const double> levels,
                                           std::span<const TrackTrial> trials,
                                           std::size_t skipped = 2);

/// What a track's answers tell of its threshold, and the observer who fits them.
struct ThresholdEstimate {
  Threshold threshold;
  /// Over the interval, also if it is open: the likeliest threshold of usual observers, and the
  /// means of their lapse rates and of the logarithm of their slopes.
  Observer observer;
  /// The ends if the lapse rate is a usual one, Beta(1, 10); of a threshold without a number.
  Threshold attentive{};
};

/// The threshold of answers at any levels, chosen by any procedure, with nothing assumed of the
/// observer but the shape. The interval holds the thresholds whose likelihood, averaged over widths
/// and lapse rates, is not rejected by its ratio to the largest (chi-square, one degree). The
/// threshold has a number if that of usual observers lies inside the levels, and if they reject
/// in the same way that nothing is felt at any level, and that everything is; an end farther from
/// the levels than their range is then open. If not, an end outside the levels is open; and it is
/// below the levels if the whole interval is, and above them if the whole interval with usual lapse
/// rates is: somebody who always guesses might as well lapse in half of the trials. The lowest
/// (highest) level is then its one end.
/// \param counts    ascending; may be empty
/// \param levels    those of the track in dB, ascending, at least one
/// \param guess     in (0, 1)
/// \param interval  the interval's probability, in (0, 1)
/// \throws std::invalid_argument if an argument is outside its range
[[nodiscard]] ThresholdEstimate estimate_threshold(std::span<const LevelCounts> counts,
                                                   std::span<const double> levels, Shape shape,
                                                   double guess, double interval = 0.95);

/// What a fit by maximum likelihood may change.
struct FitOptions {
  Shape shape = Shape::weibull;
  double guess = 0.5;             ///< set by the task
  std::optional<double> slope{};  ///< nothing: fitted
  std::optional<double> lapse{};  ///< nothing: fitted
  double most_lapse = 0.1;        ///< a fitted lapse lies in [0, most_lapse]
};

struct Fit {
  Observer observer;
  double log_likelihood = 0.0;
  double deviance = 0.0;
};

/// The most likely observer. The threshold is searched up to the range of levels beyond their ends,
/// the width of the function between a quarter of the least distance of levels and five ranges.
/// \throws std::invalid_argument with fewer than two levels, impossible counts or options
[[nodiscard]] Fit fit_observer(std::span<const LevelCounts> counts, const FitOptions& options);

/// Goodness of fit against data of the fitted observer itself, each fitted again.
struct GoodnessOfFit {
  double deviance = 0.0;
  double p = 1.0;                    ///< of a deviance at least as large; never 0
  std::vector<double> thresholds{};  ///< of the simulated data, ascending: a parametric bootstrap
};

/// \param draws  >= 1
/// \throws std::invalid_argument as fit_observer does, or if draws < 1
[[nodiscard]] GoodnessOfFit goodness_of_fit(std::span<const LevelCounts> counts,
                                            const FitOptions& options, int draws,
                                            RandomStream& random);

}  // namespace touchtrial::procedures
