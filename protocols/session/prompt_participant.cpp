#include "protocols/session/prompt_participant.hpp"

namespace touchtrial::session {

std::optional<StepReply> PromptParticipant::attend(const Step& step) {
  StepReply reply;
  if (const auto* const asked = std::get_if<AnswerStep>(&step)) {
    const ParticipantAnswer given = answer();
    reply.position = given.position;
    reply.took = given.thought;
    if (asked->confidence_levels > 0) reply.confidence = 1;
  }
  if (const auto* const asked = std::get_if<QuestionStep>(&step)) {
    reply.answers.resize(asked->questionnaire->questions.size());
  }
  if (std::holds_alternative<BreakStep>(step)) rest();
  return reply;
}

}  // namespace touchtrial::session
