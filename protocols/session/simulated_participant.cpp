#include "protocols/session/simulated_participant.hpp"

#include "protocols/session/simulated_exploration.hpp"

namespace touchtrial::session {

SimulatedParticipant::SimulatedParticipant(const SubjectModel& subject,
                                           const FeltKnowledge& knowledge, std::uint64_t seed,
                                           int number)
    : subject_(subject),
      knowledge_(knowledge),
      seed_(seed),
      number_(number),
      individual_(subject, seed, number),
      decision_(individual_, knowledge) {}

void SimulatedParticipant::see_pictures(const std::vector<std::string>& labels) {
  pictures_ = see(labels, subject_, individual_, knowledge_);
}

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
  return decision_.answer(sense_.features(), pictures_, random);
}

}  // namespace touchtrial::session
