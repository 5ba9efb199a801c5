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

/// A person's threshold. If a threshold curve defines the sense, features are logarithms of
/// intensities in units of the threshold. A person perceives a feature f as
/// 0.5 ln(share exp(2 f) + floor), so that features far below the threshold are indistinguishable.
struct FeltFloor {
  double share = 1.0;  ///< factor on the power for the person's sensitivity, > 0
  double floor = 1.0;  ///< power perceived without any stimulus, > 0

  void apply_to(std::span<double> features) const noexcept;
};

/// The d' with 79.4 % right answers among three intervals, to which a one-up three-down track
/// converges.
inline constexpr double kThresholdDPrime = 1.6232289;

/// \return the standard deviation of the noise of a texture's strength, the mean of all features
[[nodiscard]] double strength_noise(engine::FeltNoise noise) noexcept;

/// Computes the floor for which a vibration at the curve's threshold has kThresholdDPrime. The
/// noise thus determines the floor; noise below 1 % counts as 1 %.
/// \param more_sensitive_db  the person's sensitivity re the curve, dB
[[nodiscard]] FeltFloor floor_of(engine::FeltNoise noise, double more_sensitive_db) noexcept;

/// \return the examples as a person with this floor perceives them; unchanged without a floor
[[nodiscard]] std::vector<engine::FeltExample> perceived_examples(
    const FeltKnowledge& knowledge, const std::optional<FeltFloor>& floor);

}  // namespace touchtrial::simulation
