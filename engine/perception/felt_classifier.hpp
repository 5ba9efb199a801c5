/// \file Tells classes apart by felt intensities, as someone who has felt examples of each.
/// Source: docs/method.md, "Felt features".
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial {

/// What an example of a class felt like.
struct FeltExample {
  int label = 0;                 ///< from 0, without gaps
  std::vector<double> features;  ///< logarithms of intensities, as many in every example
};

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

  [[nodiscard]] int labels() const noexcept { return static_cast<int>(means_.size()); }

  /// Logarithm of each label's probability density at these features.
  /// \throws std::invalid_argument if their number is not that of the examples
  [[nodiscard]] std::vector<double> log_likelihoods(std::span<const double> features) const;

 private:
  [[nodiscard]] std::vector<double> whitened(std::span<const double> features) const;

  std::size_t dimensions_;
  std::vector<double> factor_;              ///< Cholesky factor, row-major, lower triangle
  std::vector<std::vector<double>> means_;  ///< whitened, by label
  double log_peak_ = 0.0;                   ///< density at a mean
};

}  // namespace touchtrial
