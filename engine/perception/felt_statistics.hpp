/// \file What is left of felt examples once they are learnt: enough to make a classifier, and to
/// forget any one of them again. Source: docs/method.md, "Felt features".
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {

/// What an example of a class felt like.
struct FeltExample {
  int label = 0;                 ///< from 0, without gaps
  std::vector<double> features;  ///< logarithms of intensities, as many in every example
};

/// Of each label the number of its examples and their mean, and of all together the sum of outer
/// products of what sets examples apart from their label's mean. The same as sums and sums of outer
/// products, but without the loss of digits that subtracting those would bring.
class FeltStatistics {
 public:
  /// \param labels,features  how many, >= 1
  /// \throws std::invalid_argument if one is not
  FeltStatistics(int labels, std::size_t features);

  /// A rank-one update. Cost: features^2.
  /// \throws std::invalid_argument if the label is out of range, or the features are of another
  ///   number or not finite
  void learn(int label, std::span<const double> features);

  /// As if that example had never been learnt. \pre it was learnt
  /// \throws std::invalid_argument as learn, or if the label has no example
  void forget(int label, std::span<const double> features);

  [[nodiscard]] int labels() const noexcept { return static_cast<int>(counts_.size()); }
  [[nodiscard]] std::size_t features() const noexcept { return features_; }
  /// Examples of a label.
  [[nodiscard]] int count(int label) const noexcept { return counts_[label]; }
  /// All examples, less one for each label that has any.
  [[nodiscard]] int degrees_of_freedom() const noexcept;
  /// Zeros if the label has no example.
  [[nodiscard]] std::span<const double> mean(int label) const noexcept;
  /// features x features, row-major, symmetric.
  [[nodiscard]] std::span<const double> scatter() const noexcept { return scatter_; }

 private:
  void check(int label, std::span<const double> features) const;
  /// Adds weight * d d^T, d being what sets the features apart from the label's mean.
  void add_to_scatter(int label, std::span<const double> features, double weight);

  std::size_t features_;
  std::vector<int> counts_;
  std::vector<double> means_;  ///< by label, features_ each
  std::vector<double> scatter_;
};

}  // namespace touchtrial::engine
