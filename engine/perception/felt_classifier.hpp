/// \file Classifies felt intensities, like a person who has felt examples of each class. Source:
/// docs/method.md, "Felt features".
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {

/// One felt example of a class.
struct FeltExample {
  int label = 0;                 ///< from 0, without gaps
  std::vector<double> features;  ///< logarithms of intensities, the same number in every example
};

/// A summary of examples, sufficient to make a classifier and to remove examples again: for each
/// label the number of its examples and their mean; for all labels together the scatter, which is
/// the sum of the outer products of the examples' deviations from their label's mean. Plain sums
/// and sums of products would hold the same, but lose digits when they are subtracted.
class FeltStatistics {
 public:
  /// \param labels,features  their numbers, >= 1
  /// \throws std::invalid_argument if one of them is below 1
  FeltStatistics(int labels, std::size_t features);

  /// Adds an example: a rank-one update. Cost: features^2.
  /// \throws std::invalid_argument if the label is out of range, the number of features is another,
  ///   or a feature is not finite
  void learn(int label, std::span<const double> features);

  /// Removes an example.
  /// \pre it was learnt
  /// \throws std::invalid_argument as learn, or if the label has no example
  void forget(int label, std::span<const double> features);

  [[nodiscard]] int labels() const noexcept { return static_cast<int>(counts_.size()); }
  [[nodiscard]] std::size_t features() const noexcept { return features_; }
  /// Number of examples of a label.
  [[nodiscard]] int count(int label) const noexcept { return counts_[label]; }
  /// The number of examples minus the number of labels that have any.
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

/// Normal noise of perception on features, which are logarithms of intensities. Implicitly converts
/// from independent noise only.
struct FeltNoise {
  constexpr FeltNoise(double own_sd, double common_sd = 0.0)  // NOLINT(google-explicit-constructor)
      : own(own_sd), common(common_sd) {}
  double own;     ///< standard deviation of each feature's independent noise, >= 0
  double common;  ///< standard deviation of the noise common to all features, >= 0
};

/// Gaussian classes, each with its own mean, and one covariance for all: that of the examples
/// within classes, shrunk towards its diagonal by d / (d + degrees of freedom) for d features, plus
/// the noise of perception. Thread-safe once made.
class FeltClassifier {
 public:
  /// \param noise  of perception
  /// \throws std::invalid_argument if there is no example, a label has none, examples differ in
  ///   length, or a number is out of range or not finite
  FeltClassifier(std::span<const FeltExample> examples, FeltNoise noise);

  /// The same, within rounding, from the summary of the examples. A label without examples has
  /// likelihood 0.
  /// \throws std::invalid_argument if no label has an example, or the noise is out of range
  FeltClassifier(const FeltStatistics& statistics, FeltNoise noise);

  [[nodiscard]] int labels() const noexcept { return static_cast<int>(means_.size()); }

  /// The logarithm of each label's probability density at these features; minus infinity for a
  /// label without examples.
  /// \throws std::invalid_argument if the examples have another number of features
  [[nodiscard]] std::vector<double> log_likelihoods(std::span<const double> features) const;

 private:
  /// \param covariance  of the examples within labels, row-major, positive definite
  /// \param means  by label; empty for a label without examples
  void settle(std::vector<double> covariance, std::vector<std::vector<double>> means);
  [[nodiscard]] std::vector<double> whitened(std::span<const double> features) const;

  std::size_t dimensions_ = 0;
  std::vector<double> factor_;              ///< Cholesky factor, row-major, lower triangle
  std::vector<std::vector<double>> means_;  ///< whitened, by label; empty without examples
  double log_peak_ = 0.0;                   ///< log density at a mean
};

}  // namespace touchtrial::engine
