#include "protocols/simulation/simulated_participant.hpp"

#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_exploration.hpp"

namespace touchtrial::simulation {

device::HapticDevice& SimulatedParticipant::begin_exploring(const PlaneGeometry& plane) {
  ++trials_begun_;
  sense_.reset(plane);
  RandomStream random = stream_of_trial(seed_, kExplorationPurpose, number_, trials_begun_);
  return hand_.emplace(make_exploring_hand(subject_, plane, random));
}

void SimulatedParticipant::feel(const device::ServoSample& sample) noexcept {
  sense_.feel(sample.position_mm, sample.force_n);
}

ParticipantAnswer SimulatedParticipant::answer() {
  RandomStream random = stream_of_trial(seed_, kAnswerPurpose, number_, trials_begun_);
  return choose(sense_.features(), random);
}

}  // namespace touchtrial::simulation
