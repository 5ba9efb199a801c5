/// \file Answers that a blindfolded participant speaks and the experimenter enters.
#pragma once

#include "protocols/session/participant.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// What the experimenter entered.
struct SpokenAnswer {
  std::size_t label = 0;             ///< index into the labels that were shown
  std::optional<std::size_t> first;  ///< before a change
  std::optional<int> confidence;
};

/// Where spoken answers are entered: a terminal.
class SpokenEntry {
 public:
  virtual ~SpokenEntry() = default;
  /// Called over and over until there is an answer; the session's thread. May block for a moment.
  /// \param labels  in alphabetical order, the same for every participant: says nothing of what is
  ///   presented
  [[nodiscard]] virtual std::optional<SpokenAnswer> spoken_answer(
      const session::AnswerStep& step, const std::vector<std::string>& labels) = 0;
  /// What was entered and not confirmed counts no more: a plane is on.
  virtual void forget_spoken_answer() = 0;
};

/// Shows each step to `participant`, and takes the replies to answers that are to be spoken (sight
/// "blindfold") from `entry`. Everything else is the participant's own.
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
  std::vector<int> positions_;  ///< of the sorted labels, in the participant's layout
};

}  // namespace touchtrial::app
