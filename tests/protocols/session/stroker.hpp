/// \file A participant who strokes the plane as simulated participants do, and gives no answers.
#pragma once

#include "protocols/simulation/felt_exploration.hpp"
#include "protocols/simulation/simulated_participant.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {

/// Keeps the device's samples.
class Stroker final : public simulation::PromptParticipant {
 public:
  /// \param random  for the path, which is the same in every exploration
  explicit Stroker(const RandomStream& random, simulation::SubjectModel subject = {})
      : random_(random), subject_(std::move(subject)) {}

  void see_pictures(const std::vector<std::string>&) override {}
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    RandomStream random = random_;
    return hand_.emplace(simulation::make_exploring_hand(subject_, plane, random));
  }
  void feel(const device::ServoSample& sample) noexcept override { felt.push_back(sample); }
  [[nodiscard]] simulation::ParticipantAnswer answer() override { return {}; }

  std::vector<device::ServoSample> felt;

 private:
  RandomStream random_;
  simulation::SubjectModel subject_;
  std::optional<device::SimulatedHand> hand_;
};

}  // namespace touchtrial
