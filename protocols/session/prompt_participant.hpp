/// \file A participant who never lets anybody wait.
#pragma once

#include "protocols/session/participant.hpp"

#include <chrono>

namespace touchtrial::session {

/// A choice, and the time that it took after exploring.
struct ParticipantAnswer {
  int position = 0;  ///< index into the pictures, from 0
  std::chrono::nanoseconds thought{};
};

/// Replies to every step at once; only what is answered is left to say. Leaves every question of a
/// questionnaire out.
class PromptParticipant : public Participant {
 public:
  [[nodiscard]] std::optional<StepReply> attend(const Step& step) final;

  /// The choice after exploring.
  [[nodiscard]] virtual ParticipantAnswer answer() = 0;
  /// A break.
  virtual void rest() {}
};

}  // namespace touchtrial::session
