/// \file Tells classes apart by felt intensities, as someone who has felt examples of each.
/// Source: docs/method.md, "Felt features".
#pragma once

#include "engine/perception/felt_statistics.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {

/// Gaussian classes with a mean each and one covariance: that of the examples within classes,
/// shrunk towards its diagonal by d / (d + degrees of freedom) for d features, plus the noise with
/// which features are perceived. Thread-safe once made.
class FeltClassifier {
 public:
  /// \param noise  standard deviation of the perceptual noise of every feature, >= 0; for
  ///   logarithms of intensities, the Weber fraction
  /// \throws std::invalid_argument if there is no example, a label has none, examples differ in
  ///   length, or a number is not finite
  FeltClassifier(std::span<const FeltExample> examples, double noise);

  /// The same from what is left of examples, but for rounding. A label without examples is never
  /// likely.
  /// \throws std::invalid_argument if no label has an example, or the noise is impossible
  FeltClassifier(const FeltStatistics& statistics, double noise);

  [[nodiscard]] int labels() const noexcept { return static_cast<int>(means_.size()); }

  /// Logarithm of each label's probability density at these features; minus infinity for a label
  /// without examples.
  /// \throws std::invalid_argument if their number is not that of the examples
  [[nodiscard]] std::vector<double> log_likelihoods(std::span<const double> features) const;

 private:
  /// \param covariance  of the examples within labels, row-major, positive definite
  /// \param means  by label; empty: no example
  void settle(std::vector<double> covariance, std::vector<std::vector<double>> means);
  [[nodiscard]] std::vector<double> whitened(std::span<const double> features) const;

  std::size_t dimensions_ = 0;
  std::vector<double> factor_;              ///< Cholesky factor, row-major, lower triangle
  std::vector<std::vector<double>> means_;  ///< whitened, by label; empty: no example
  double log_peak_ = 0.0;                   ///< density at a mean
};

}  // namespace touchtrial::engine
