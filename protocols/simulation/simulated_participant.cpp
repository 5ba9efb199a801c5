#include "protocols/simulation/simulated_participant.hpp"

#include "protocols/simulation/felt_decision.hpp"

namespace touchtrial::simulation {

device::HapticDevice& SimulatedParticipant::begin_exploring(const PlaneGeometry& plane) {
  ++trials_begun_;
  RandomStream random = stream_of_trial(seed_, kExplorationPurpose, number_, trials_begun_);
  const device::HandFactors factors =
      hand_of_participant(subject_, seed_, static_cast<std::uint64_t>(number_));
  sense_.begin(hand_.emplace(make_exploring_hand(subject_, plane, random, factors)), plane);
  return *hand_;
}

void SimulatedParticipant::feel(const device::ServoSample& sample) noexcept {
  sense_.feel(sample);
}

ParticipantAnswer SimulatedParticipant::answer() {
  RandomStream random = stream_of_trial(seed_, kAnswerPurpose, number_, trials_begun_);
  return choose(sense_.features(), random);
}

}  // namespace touchtrial::simulation
