/// \file A classifier's supports as the linear functions of features that they are.
#pragma once

#include "engine/perception/felt_features.hpp"
#include "protocols/session/felt_knowledge.hpp"

#include <span>
#include <vector>

namespace touchtrial::planning {

/// Log densities of prototypes for someone with a Weber fraction, less that of the first: linear in
/// the features, since the classifier's covariance is shared. Immutable, thread-safe.
class LinearSupports {
 public:
  /// Asks a FeltClassifier at the examples' mean and one step along each feature. Cost: some 30 us.
  /// \param weber  > 0
  LinearSupports(const session::FeltKnowledge& knowledge, double weber);

  [[nodiscard]] int prototypes() const noexcept { return static_cast<int>(constant_.size()); }
  /// Dimensions of the noise that sets supports apart.
  [[nodiscard]] int dimensions() const noexcept { return dimensions_; }

  /// Supports before noise. \param supports  one a prototype
  void at(const engine::FeltFeatures& felt, std::span<double> supports) const noexcept;

  /// What a noise of the Weber fraction on every feature adds to supports: linear in as many
  /// independent standard normals as there are dimensions.
  /// \param normals  dimensions() numbers  \param supports  one a prototype
  void noise(std::span<const double> normals, std::span<double> supports) const noexcept;

 private:
  void factorise_noise(double weber);

  int dimensions_;
  engine::FeltFeatures middle_{};
  std::vector<double> constant_;  ///< by prototype, at the middle
  std::vector<double> gradient_;  ///< [prototype x kFeltFeatures]
  std::vector<double> factor_;    ///< [prototype x dimensions]: the noise's Cholesky factor
};

/// How many independent normals the noise amounts to with so many prototypes.
[[nodiscard]] int noise_dimensions(int prototypes) noexcept;

}  // namespace touchtrial::planning
