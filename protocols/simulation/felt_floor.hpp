/// \file A person's threshold and noise in the logarithms of felt intensities.
/// Source: docs/perception.md, "What is felt".
#pragma once

#include "engine/perception/felt_classifier.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::simulation {

/// With a sense by a curve, features are logarithms of intensities in thresholds. A person feels
/// 0.5 ln(share exp(2 f) + floor) of a feature f: those far below the threshold are all alike.
struct FeltFloor {
  double share = 1.0;  ///< of the power, by how sensitive the person is, > 0
  double floor = 1.0;  ///< power of what is felt where there is nothing, > 0

  void apply_to(std::span<double> features) const noexcept;
};

/// The d' at which 79.4 % of answers among three intervals are right, where a one-up three-down
/// track settles.
inline constexpr double kThresholdDPrime = 1.6232289;

/// \return the standard deviation of the noise of a texture's strength: of the mean of all features
[[nodiscard]] double strength_noise(engine::FeltNoise noise) noexcept;

/// \return the floor above which a vibration at the curve's threshold stands by kThresholdDPrime:
///   floor and noise are one parameter. Noise below 1 % counts as 1 %.
/// \param more_sensitive_db  than the curve
[[nodiscard]] FeltFloor floor_of(engine::FeltNoise noise, double more_sensitive_db) noexcept;

/// \return what was learnt as a person feels it; without a floor, as it is
[[nodiscard]] std::vector<engine::FeltExample> examples_above(
    const FeltKnowledge& knowledge, const std::optional<FeltFloor>& floor);

}  // namespace touchtrial::simulation
