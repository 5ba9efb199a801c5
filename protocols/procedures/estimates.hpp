/// \file Thresholds of finished tracks, with intervals, and how well a function fits. A track that
/// reached a bound of its levels is censored: it says on which side the threshold lies, and gives
/// none. Formulas and sources: docs/thresholds.md, "Estimates".
#pragma once

#include "core/random.hpp"
#include "protocols/procedures/posterior.hpp"
#include "protocols/procedures/tracks.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::procedures {

/// Where a threshold lies that the levels do not hold.
enum class Censored { no, below, above };

/// A level, with limits of its interval. Without `censored == no` all are empty.
struct Threshold {
  std::optional<double> level;
  std::optional<double> low;  ///< nothing: the interval is open on this side, or there is none
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

/// The posterior mean of the grid's threshold, with an equal-tailed credible interval.
/// \return censored if the mean lies outside the levels, or a twentieth of the probability on the
///   first or last value of a grid of at least three
/// \throws std::invalid_argument as Posterior and credible_interval do
[[nodiscard]] Threshold posterior_threshold(const Posterior& posterior,
                                            std::span<const double> levels, double level = 0.95);

/// The posterior of a track's answers.
/// \throws std::invalid_argument as Posterior does
[[nodiscard]] Posterior posterior_of(std::span<const double> levels, const ParameterGrid& grid,
                                     std::span<const TrackTrial> trials);

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

/// The fitted threshold and its profile-likelihood interval: all thresholds whose best observer is
/// not rejected by the likelihood ratio (chi-square, one degree).
/// \return censored if the threshold lies outside the levels; an end that is not found within the
///   searched range is open
/// \throws std::invalid_argument as fit_observer does, or if the level is not in (0, 1)
[[nodiscard]] Threshold likelihood_threshold(std::span<const LevelCounts> counts,
                                             const FitOptions& options, double level = 0.95);

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
