/// \file The posterior of an observer on a grid of threshold, slope and lapse, and the expected
/// entropy after one more trial at each level. Sources: Kontsevich, Tyler 1999; Prins 2013; Watson
/// 2017; docs/thresholds.md, "QUEST+, psi and psi-marginal".
#pragma once

#include "protocols/procedures/psychometric_function.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::procedures {

/// The possible observers and their prior probabilities. A parameter with a single value is fixed.
struct ParameterGrid {
  Shape shape = Shape::weibull;
  std::vector<double> thresholds;         ///< ascending
  std::vector<double> slopes;             ///< ascending, > 0
  double guess = 0.5;                     ///< guess rate, set by the task
  std::vector<double> lapses;             ///< ascending
  std::vector<double> threshold_prior{};  ///< weights >= 0, one for each value; empty: flat
  std::vector<double> slope_prior{};
  std::vector<double> lapse_prior{};
};

/// The parameters that are marginalised before the entropy is computed (psi-marginal).
enum class Nuisance { none, lapse, slope_and_lapse };

/// Values of one parameter and their probabilities, which add up to 1.
struct Marginal {
  std::vector<double> values;
  std::vector<double> weights;
};

[[nodiscard]] double mean_of(const Marginal& marginal) noexcept;
[[nodiscard]] double sd_of(const Marginal& marginal) noexcept;

/// A posterior on a grid. All sums have a fixed order, so that the same grid and answers give the
/// same bits on one machine. Not thread-safe.
class Posterior {
 public:
  /// Tabulates the likelihood: 16 bytes for each level and grid point.
  /// \param levels  finite, at least one
  /// \throws std::invalid_argument if a list is empty or not ascending, an observer is impossible,
  ///   a prior has a wrong length or no weight, or the tables would exceed 20 million numbers
  Posterior(std::span<const double> levels, ParameterGrid grid);

  /// Updates the posterior by Bayes' rule. An answer that is impossible for every observer with a
  /// positive weight leaves the posterior unchanged.
  /// \param level  index into the levels, less than their number
  void observe(std::size_t level, bool correct) noexcept;

  /// The expected entropy, in nats, of all parameters except the nuisance after one more trial at
  /// each level. O(levels x grid points), without a logarithm for each grid point.
  [[nodiscard]] std::vector<double> expected_entropies(Nuisance nuisance) const;

  /// The first level whose expected entropy is within 1e-9 of the minimum.
  [[nodiscard]] std::size_t best_level(Nuisance nuisance) const;

  /// The weights of all grid points. The threshold varies slowest, the lapse rate fastest.
  [[nodiscard]] const std::vector<double>& weights() const noexcept { return weights_; }
  [[nodiscard]] const ParameterGrid& grid() const noexcept { return grid_; }

  [[nodiscard]] Marginal threshold() const;
  [[nodiscard]] Marginal slope() const;
  [[nodiscard]] Marginal lapse() const;
  /// The most probable grid point; the first of equal ones.
  [[nodiscard]] Observer mode() const;

 private:
  [[nodiscard]] std::span<const double> row(const std::vector<double>& table,
                                            std::size_t level) const noexcept;
  [[nodiscard]] double joint_entropy_at(std::size_t level, double entropy_now) const noexcept;
  [[nodiscard]] double marginal_entropy_at(std::size_t level,
                                           std::size_t nuisance_points) const noexcept;

  ParameterGrid grid_;
  std::size_t level_count_;
  std::vector<double> weights_;
  std::vector<double> correct_;         ///< level by grid point: probability of a right answer
  std::vector<double> answer_entropy_;  ///< level by grid point: entropy of the answer
};

/// The first position within 1e-9 of the minimum of `entropies`. The tolerance keeps rounding
/// errors of sums, exp and log from affecting the result.
/// \pre not empty
[[nodiscard]] std::size_t first_min(std::span<const double> entropies) noexcept;

}  // namespace touchtrial::procedures
