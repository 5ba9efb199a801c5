#include "protocols/simulation/felt_floor.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::simulation {

void FeltFloor::apply_to(std::span<double> features) const noexcept {
  for (double& feature : features) {
    feature = 0.5 * std::log(share * std::exp(2.0 * feature) + floor);
  }
}

double strength_noise(engine::FeltNoise noise) noexcept {
  return std::hypot(noise.common, noise.independent / std::sqrt(double{engine::kFeltFeatures}));
}

FeltFloor floor_of(engine::FeltNoise noise, double more_sensitive_db) noexcept {
  constexpr double kMinNoise = 0.01;
  const double step = kThresholdDPrime * std::max(strength_noise(noise), kMinNoise);
  // At the threshold the power is 1, so 0.5 ln((1 + floor) / floor) must equal the step.
  return {std::pow(10.0, more_sensitive_db / 10.0), 1.0 / std::expm1(2.0 * step)};
}

std::vector<engine::FeltExample> perceived_examples(const FeltKnowledge& knowledge,
                                                    const std::optional<FeltFloor>& floor) {
  std::vector<engine::FeltExample> examples = knowledge.examples;
  if (!floor) return examples;
  for (engine::FeltExample& example : examples) floor->apply_to(example.features);
  return examples;
}

}  // namespace touchtrial::simulation
