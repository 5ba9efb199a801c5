/// \file A participant who feels: knows the classes by touch, and answers from what was felt.
#pragma once

#include "device/simulated/simulated_hand.hpp"
#include "engine/perception/texture_sense.hpp"
#include "protocols/session/felt_decision.hpp"
#include "protocols/session/felt_knowledge.hpp"
#include "protocols/session/individual.hpp"
#include "protocols/session/prompt_participant.hpp"
#include "protocols/session/subject_model.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// In each trial: strokes the plane on a path of its own, perceives the felt intensities with
/// Weber noise, and names the picture whose class makes them likeliest, bias included; or lapses,
/// and names any. Everything random comes from the seed, the participant's number, and how many
/// trials came before. Refers to subject and knowledge, which must outlive it.
class SimulatedParticipant final : public PromptParticipant {
 public:
  /// \param number  from 1
  SimulatedParticipant(const SubjectModel& subject, const FeltKnowledge& knowledge,
                       std::uint64_t seed, int number);

  /// \throws std::invalid_argument if a class that was learnt has no picture
  void see_pictures(const std::vector<std::string>& labels) override;
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override;
  void feel(const device::ServoSample& sample) noexcept override;
  [[nodiscard]] ParticipantAnswer answer() override;

 private:
  const SubjectModel& subject_;
  const FeltKnowledge& knowledge_;
  std::uint64_t seed_;
  int number_;
  Individual individual_;
  FeltDecision decision_;
  engine::TextureSense sense_;
  std::optional<device::SimulatedHand> hand_;
  SeenPictures pictures_;
  std::uint64_t trials_begun_ = 0;
};

}  // namespace touchtrial::session
