/// \file A classifier's supports for prototypes, how noise moves them along straight lines, and the
/// probability that each picture wins along such a line. Source: docs/planning.md, "Probabilities
/// of answers". Private to analysis/planning.
#pragma once

#include "engine/perception/felt_classifier.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/simulation/felt_floor.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::planning {

/// \return the number of independent normals that describe the noise of the supports
[[nodiscard]] int noise_dimensions(int prototypes) noexcept;

/// Log densities of the prototypes, relative to the first, for a person with a given noise of
/// features. They are linear in the features because all prototypes share one covariance.
/// Immutable, thread-safe.
class LinearSupports {
 public:
  /// Evaluates a FeltClassifier at the examples' mean and one step along each feature. Cost:
  /// about 30 us.
  /// \param noise  noise of the person's features; its independent part must be > 0
  /// \param floor  the person's sensory floor, if there is one
  LinearSupports(const simulation::FeltKnowledge& knowledge, engine::FeltNoise noise,
                 const std::optional<simulation::FeltFloor>& floor = {});

  /// Computes the supports without noise.
  /// \param felt  features before the person's floor is applied
  /// \param supports  receives one number per prototype
  void compute_supports(engine::FeltFeatures felt, std::span<double> supports) const noexcept;

  /// Computes the effect of the features' noise on the supports, a linear function of independent
  /// standard normals.
  /// \param normals  noise_dimensions(prototypes) numbers
  /// \param supports  receives one number per prototype
  void compute_noise(std::span<const double> normals, std::span<double> supports) const noexcept;

 private:
  void factorise_noise(engine::FeltNoise noise);

  int dimensions_;
  std::optional<simulation::FeltFloor> floor_;
  engine::FeltFeatures middle_{};
  std::vector<double> constant_;  ///< by prototype, at the middle
  std::vector<double> gradient_;  ///< [prototype x kFeltFeatures]
  std::vector<double> factor_;    ///< [prototype x dimensions]: the noise's Cholesky factor
};

/// Points of Sobol's sequence with a random digital shift, as independent standard normals.
class NoisePoints {
 public:
  /// \param dimensions  of each point, >= 1
  /// \param count  number of points
  /// \param index  selects the shift: each index gives different points
  NoisePoints(int dimensions, std::size_t count, std::uint64_t seed, std::uint64_t index);

  [[nodiscard]] std::span<const double> point(std::size_t i) const noexcept {
    return {normals_.data() + i * dimensions_, dimensions_};
  }

 private:
  std::size_t dimensions_;
  std::vector<double> normals_;
};

/// \return the means of equally likely groups of a standard normal, scaled to its variance
[[nodiscard]] std::vector<double> normal_groups(int groups);

/// The signed length of an isotropic normal noise vector along a line through the origin. Length
/// and direction of d independent standard normals are independent; the signed length is symmetric,
/// and its absolute value is chi-distributed with d degrees of freedom. Tabulated once (cubic
/// between 2,048 points on each side, error below 1e-9). Immutable, thread-safe.
class RadialDistribution {
 public:
  /// \param dimensions  d, >= 1
  /// \throws std::invalid_argument if dimensions < 1
  explicit RadialDistribution(int dimensions);

  struct Value {
    double below = 0.0;    ///< probability of a length less than t
    double density = 0.0;  ///< at t
  };
  [[nodiscard]] Value at(double t) const noexcept;

 private:
  double max_length_;  ///< longer lengths are ignored
  double step_;
  std::vector<double> tail_;     ///< P(absolute length > i steps)
  std::vector<double> density_;  ///< its density per step
};

/// Adds to each picture's answer the probability that the picture has the largest support. Along
/// the line, prototype k has the support supports[k] + t * slope[k], where t is random. A picture's
/// support is the largest among its prototypes. Equal supports share the probability.
/// \param picture  index of each prototype's picture
/// \param noise  distribution of t
/// \param weight  of this line
/// \param answers  by picture
/// \param slopes  empty, or [answer x pictures + picture]: receives the derivatives with respect to
///   a constant added to a picture's support
void add_winners(std::span<const double> supports, std::span<const double> slope,
                 std::span<const int> picture, const RadialDistribution& noise, double weight,
                 std::span<double> answers, std::span<double> slopes) noexcept;

}  // namespace touchtrial::planning
