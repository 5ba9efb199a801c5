/// \file Thresholds of finished tracks, with intervals, and goodness of fit. A threshold is
/// censored if the answers do not show that it is within the levels: it then has a side or bounds
/// instead of a number. Formulas and sources: docs/thresholds.md, "Estimates".
#pragma once

#include "core/random.hpp"
#include "protocols/procedures/psychometric_function.hpp"
#include "protocols/procedures/tracks.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::procedures {

/// Whether a threshold has a number, and if not, on which side of the levels it is.
enum class Censored {
  no,            ///< it has a number
  below,         ///< it is below the levels
  above,         ///< it is above the levels
  undetermined,  ///< the answers determine neither a number nor a side
};

/// A threshold and its interval, in units of the level.
struct Threshold {
  std::optional<double> level;  ///< only if `censored` is no
  std::optional<double> low;    ///< empty: the interval is open on this side, or there is none
  std::optional<double> high;
  Censored censored = Censored::no;
};

/// The levels of a staircase's reversals, in order. At a reversal, the level is higher than before
/// and after, or lower.
[[nodiscard]] std::vector<std::size_t> reversals_of(std::span<const TrackTrial> trials);

/// Estimates the level with proportion convergence_of() as the mean of the last reversals, an even
/// number of them. The estimate has no interval. It is biased by the size of the last steps and, in
/// short tracks, towards the first level (docs/procedures-recovery.md).
/// \param skipped  reversals at the start that are ignored, >= 0
/// \return no level with fewer than two reversals; censored if a counted reversal is at a bound, or
///   the last trial if there are no reversals
/// \throws std::invalid_argument if there are no trials or levels
[[nodiscard]] Threshold reversal_threshold(std::span<const double> levels,
                                           std::span<const TrackTrial> trials,
                                           std::size_t skipped = 2);

// The observers over whom estimate_threshold averages likelihoods. The width of a function is from
// F = .05 to .95.
inline constexpr double kMinWidth_db = 2.0;
inline constexpr double kMaxWidth_db = 60.0;
inline constexpr double kMaxLapse = 0.5;    ///< of all observers
inline constexpr double kWidthPower = 0.5;  ///< the density of widths is width^kWidthPower
inline constexpr double kLapseBeta =
    3.0;  ///< the lapse rate is Beta(1, kLapseBeta), up to kMaxLapse
// Typical observers.
inline constexpr double kTypicalWidth_db = 10.0;   ///< median width
inline constexpr double kTypicalSpread = 0.8;      ///< SD of the natural logarithm of the width
inline constexpr double kTypicalLapseBeta = 10.0;  ///< the lapse rate is Beta(1, kTypicalLapseBeta)

/// The threshold of a track, and the observer who fits its answers.
struct ThresholdEstimate {
  Threshold threshold;
  /// The most likely threshold of typical observers within the interval (also if it is open), with
  /// the means of their lapse rates and log slopes.
  Observer observer;
  /// The bounds of a threshold without a number, for typical lapse rates.
  Threshold attentive{};
};

/// Estimates the threshold from answers at any levels, chosen by any procedure. It assumes nothing
/// about the observer except the shape of the function.
///
/// The interval contains the thresholds that a likelihood-ratio test does not reject (chi-square,
/// one degree of freedom), with likelihoods averaged over widths and lapse rates. The threshold has
/// a number if two conditions hold: the threshold of typical observers is within the levels, and
/// the same test rejects both that nothing is felt at any level and that everything is felt at
/// every level. An end of the interval is then open if it is farther from the levels than their
/// range.
///
/// Otherwise, an end outside the levels is open. The threshold is below the levels if the entire
/// interval is. It is above the levels if the entire interval for typical lapse rates is, because
/// the answers of an observer who always guesses also fit an observer who lapses in half of the
/// trials. The interval of a threshold below (above) the levels has only one end, the lowest
/// (highest) level.
/// \param counts    ascending; may be empty
/// \param levels    of the track in dB, ascending, at least one
/// \param guess     in (0, 1)
/// \param interval  the interval's probability, in (0, 1)
/// \throws std::invalid_argument if an argument is outside its range
[[nodiscard]] ThresholdEstimate estimate_threshold(std::span<const LevelCounts> counts,
                                                   std::span<const double> levels, Shape shape,
                                                   double guess, double interval = 0.95);

/// The parameters of a fit by maximum likelihood.
struct FitOptions {
  Shape shape = Shape::weibull;
  double guess = 0.5;             ///< guess rate, set by the task
  std::optional<double> slope{};  ///< empty: fitted
  std::optional<double> lapse{};  ///< empty: fitted
  double max_lapse = 0.1;         ///< a fitted lapse is in [0, max_lapse]
};

struct Fit {
  Observer observer;
  double log_likelihood = 0.0;
  double deviance = 0.0;
};

/// Finds the most likely observer. The threshold is at most one range of the levels beyond their
/// ends, and the width of the function is between a quarter of the minimum distance of levels and
/// five times their range.
/// \throws std::invalid_argument if there are fewer than two levels, or if counts or options are
///   impossible
[[nodiscard]] Fit fit_observer(std::span<const LevelCounts> counts, const FitOptions& options);

/// Goodness of fit by parametric bootstrap, with data simulated from the fitted observer.
struct GoodnessOfFit {
  double deviance = 0.0;
  double p = 1.0;                    ///< share of simulated deviances at least as large; never 0
  std::vector<double> thresholds{};  ///< of the simulated data, ascending
};

/// \param draws  simulated data sets, >= 1
/// \throws std::invalid_argument as fit_observer, or if draws < 1
[[nodiscard]] GoodnessOfFit goodness_of_fit(std::span<const LevelCounts> counts,
                                            const FitOptions& options, int draws,
                                            RandomStream& random);

}  // namespace touchtrial::procedures
