/// \file A participant with a simulated hand and a sense of touch.
#pragma once

#include "core/random.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "engine/perception/felt_features.hpp"
#include "engine/perception/texture_sense.hpp"
#include "protocols/simulation/prompt_participant.hpp"
#include "protocols/simulation/subject_model.hpp"

#include <cstdint>
#include <optional>

namespace touchtrial::simulation {

/// In each trial, strokes the plane on a new path and answers from what was felt. Everything random
/// is a function of the seed, the participant's number, and the number of earlier trials.
/// Subclasses make the choice. Refers to the subject, which must outlive it.
class SimulatedParticipant : public PromptParticipant {
 public:
  /// \param number  from 1
  SimulatedParticipant(const SubjectModel& subject, std::uint64_t seed, int number)
      : subject_(subject), seed_(seed), number_(number) {}

  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override;
  void feel(const device::ServoSample& sample) noexcept override;
  [[nodiscard]] ParticipantAnswer answer() final;

 protected:
  /// The answer to one presentation.
  /// \param felt  features without noise, natural logarithms of newtons
  /// \param random  stream_of_trial for kAnswerPurpose
  [[nodiscard]] virtual ParticipantAnswer choose(const engine::FeltFeatures& felt,
                                                 RandomStream& random) = 0;

 private:
  const SubjectModel& subject_;
  std::uint64_t seed_;
  int number_;
  engine::TextureSense sense_;
  std::optional<device::SimulatedHand> hand_;
  std::uint64_t trials_begun_ = 0;
};

}  // namespace touchtrial::simulation
