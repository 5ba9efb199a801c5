/// \file A participant who replies to every step at once.
#pragma once

#include "protocols/session/participant.hpp"

#include <chrono>
#include <optional>
#include <variant>

namespace touchtrial::simulation {

/// A choice, and the time that it took after exploring.
struct ParticipantAnswer {
  int position = 0;  ///< index of the picture, from 0
  std::chrono::nanoseconds thought{};
};

/// Leaves every question of a questionnaire out, and gives the lowest confidence. Subclasses
/// explore and choose.
class PromptParticipant : public session::Participant {
 public:
  [[nodiscard]] std::optional<session::StepReply> attend(const session::Step& step) final {
    session::StepReply reply;
    if (const auto* const asked = std::get_if<session::AnswerStep>(&step)) {
      const ParticipantAnswer given = answer();
      reply.position = given.position;
      reply.took = given.thought;
      if (asked->confidence_levels > 0) reply.confidence = 1;
    }
    if (const auto* const asked = std::get_if<session::QuestionStep>(&step)) {
      reply.answers.resize(asked->questionnaire->questions.size());
    }
    if (std::holds_alternative<session::BreakStep>(step)) rest();
    return reply;
  }

  /// The choice after exploring.
  [[nodiscard]] virtual ParticipantAnswer answer() = 0;
  /// Called at each break.
  virtual void rest() {}
};

}  // namespace touchtrial::simulation
