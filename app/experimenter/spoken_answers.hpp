/// \file Answers that a blindfolded participant speaks and the experimenter enters.
#pragma once

#include "protocols/session/participant.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// An answer as the experimenter enters it.
struct SpokenAnswer {
  std::size_t label = 0;             ///< index of the label that was chosen
  std::optional<std::size_t> first;  ///< the previous choice, if the participant changed it
  std::optional<int> confidence;
};

/// Where spoken answers are entered, for instance a terminal.
class SpokenEntry {
 public:
  virtual ~SpokenEntry() = default;
  /// The session's thread calls this repeatedly until there is an answer. May block for a moment.
  /// \param labels  in alphabetical order, so that they reveal nothing about the presentation
  [[nodiscard]] virtual std::optional<SpokenAnswer> spoken_answer(
      const session::AnswerStep& step, const std::vector<std::string>& labels) = 0;
  /// Discards an entry that is not confirmed, because a plane is on.
  virtual void forget_spoken_answer() = 0;
};

/// Shows each step to `participant`, and takes the replies to spoken answers (sight "blindfold")
/// from `entry`. Everything else comes from the participant.
class SpokenAnswers final : public session::Participant {
 public:
  /// \param participant,entry  must outlive this
  SpokenAnswers(session::Participant& participant, SpokenEntry& entry)
      : participant_(participant), entry_(entry) {}

  void see_pictures(const std::vector<std::string>& labels) override;
  [[nodiscard]] std::optional<session::StepReply> attend(const session::Step& step) override;
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    entry_.forget_spoken_answer();
    return participant_.begin_exploring(plane);
  }
  void exploring(device::ServoControl& servo) override { participant_.exploring(servo); }
  void feel(const device::ServoSample& sample) noexcept override { participant_.feel(sample); }

 private:
  session::Participant& participant_;
  SpokenEntry& entry_;
  std::vector<std::string> sorted_;
  std::vector<int> positions_;  ///< positions of the sorted labels in the participant's layout
};

}  // namespace touchtrial::app
