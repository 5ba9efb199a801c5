/// \file Classifies felt intensities by learnt examples of each class. Source: docs/method.md,
/// "Felt features".
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {

/// One example of a class.
struct FeltExample {
  int label = 0;                 ///< from 0, without gaps
  std::vector<double> features;  ///< logarithms of intensities, the same number in every example
};

/// Sufficient statistics of examples, from which examples can be removed: the number and mean of
/// each label's examples, and the scatter within all labels, that is the sum of the outer products
/// of the deviations from the label's mean. Plain sums of products would lose digits when
/// subtracted.
class FeltStatistics {
 public:
  /// \param labels,features  number of each, >= 1
  /// \throws std::invalid_argument if one of them is below 1
  FeltStatistics(int labels, std::size_t features);

  /// Adds an example: a rank-one update. Cost: features^2.
  /// \throws std::invalid_argument if the label is out of range, the number of features differs, or
  ///   a feature is not finite
  void learn(int label, std::span<const double> features);

  /// Removes an example.
  /// \pre the example was learnt
  /// \throws std::invalid_argument as learn(), or if the label has no example
  void forget(int label, std::span<const double> features);

  [[nodiscard]] int labels() const noexcept { return static_cast<int>(counts_.size()); }
  [[nodiscard]] std::size_t features() const noexcept { return features_; }
  /// Number of examples of a label.
  [[nodiscard]] int count(int label) const noexcept { return counts_[label]; }
  /// The number of examples minus the number of labels with examples.
  [[nodiscard]] int degrees_of_freedom() const noexcept;
  /// Mean of a label's examples; zeros if it has none.
  [[nodiscard]] std::span<const double> mean(int label) const noexcept;
  /// features x features, row-major, symmetric.
  [[nodiscard]] std::span<const double> scatter() const noexcept { return scatter_; }

 private:
  void check(int label, std::span<const double> features) const;
  /// Adds weight * d d^T, where d is the deviation of the features from the label's mean.
  void add_to_scatter(int label, std::span<const double> features, double weight);

  std::size_t features_;
  std::vector<int> counts_;
  std::vector<double> means_;  ///< by label, features_ each
  std::vector<double> scatter_;
};

/// Normally distributed perceptual noise on features, which are logarithms of intensities. Converts
/// implicitly from a number: the independent noise.
struct FeltNoise {
  constexpr FeltNoise(double independent_sd,
                      double common_sd = 0.0)  // NOLINT(google-explicit-constructor)
      : independent(independent_sd), common(common_sd) {}
  double independent;  ///< standard deviation of each feature's independent noise, >= 0
  double common;       ///< standard deviation of the noise common to all features, >= 0
};

/// Gaussian classes with separate means and a common covariance: the examples' covariance within
/// classes, shrunk towards its diagonal by d / (d + degrees of freedom) for d features, plus
/// perceptual noise. Thread-safe after construction.
class FeltClassifier {
 public:
  /// \throws std::invalid_argument if a label has no example, examples differ in length, or a
  ///   number is out of range or not finite
  FeltClassifier(std::span<const FeltExample> examples, FeltNoise noise);

  /// The same, within rounding, from the statistics of the examples. A label without examples has
  /// likelihood 0.
  /// \throws std::invalid_argument if no label has an example, or the noise is out of range
  FeltClassifier(const FeltStatistics& statistics, FeltNoise noise);

  [[nodiscard]] int labels() const noexcept { return static_cast<int>(means_.size()); }

  /// The logarithm of each label's probability density at these features; minus infinity for a
  /// label without examples.
  /// \throws std::invalid_argument if the number of features differs from the examples' number
  [[nodiscard]] std::vector<double> log_likelihoods(std::span<const double> features) const;

 private:
  /// \param covariance  of the examples within labels, row-major, positive definite
  /// \param means  by label; empty for a label without examples
  void initialise(std::vector<double> covariance, std::vector<std::vector<double>> means);
  [[nodiscard]] std::vector<double> whiten(std::span<const double> features) const;

  std::size_t dimensions_ = 0;
  std::vector<double> factor_;              ///< Cholesky factor, row-major, lower triangle
  std::vector<std::vector<double>> means_;  ///< whitened, by label; empty without examples
  double log_peak_ = 0.0;                   ///< log density at a mean
};

}  // namespace touchtrial::engine
