#include "protocols/session/practice_run.hpp"

#include "protocols/session/interruption_words.hpp"
#include "protocols/session/trial_run.hpp"

namespace touchtrial::session {

PracticeProgress progress_of(const std::vector<store::PracticeBody>& practised,
                             const design::PracticePlan& plan, int a_round) {
  PracticeProgress progress;
  for (const store::PracticeBody& one : practised) {
    if (one.round > progress.round) progress = {.round = one.round};
    ++progress.done;
    progress.correct += one.correct ? 1 : 0;
  }
  progress.passed = progress.correct >= plan.criterion;
  if (!progress.passed && progress.done >= a_round) progress = {.round = progress.round + 1};
  return progress;
}

PracticeRun::PracticeRun(SessionDesk& desk, const PracticeTextures& textures)
    : desk_(desk),
      textures_(textures),
      participant_(desk),
      servo_(servo_options(desk.parts())),
      a_round_(desk.parts().key.study.trials.practice) {}

PracticeProgress PracticeRun::progress() const {
  return progress_of(desk_.session().remarks().practice, desk_.parts().key.study.practice,
                     a_round_);
}

bool PracticeRun::run() {
  const int rounds = desk_.parts().key.study.practice.rounds;
  for (PracticeProgress at = progress(); !at.passed; at = progress()) {
    if (at.round > rounds) {
      if (!desk_.session().remarks().deviations.contains("practice-not-passed")) {
        desk_.session().deviate(desk_.now(), {"practice-not-passed", ""});
      }
      return true;
    }
    if (!run_round(at.round)) return false;
  }
  return true;
}

bool PracticeRun::run_round(int round) {
  const PracticeRound shown = textures_.round(round);
  desk_.parts().participant.see_pictures(shown.labels);
  desk_.enter("practice", true);
  if (!desk_.attend(PracticeStep{round})) return desk_.goes_on();
  const std::vector<int>& order = shown.order;
  for (PracticeProgress at = progress(); at.round == round && !at.passed; at = progress()) {
    if (!desk_.await_device()) {
      if (!desk_.goes_on()) return false;
      continue;
    }
    const int position = order[static_cast<std::size_t>(at.done) % order.size()];
    const std::optional<store::PracticeBody> done =
        present(at, position, *shown.models[static_cast<std::size_t>(position)]);
    if (!desk_.goes_on()) return false;
    if (!done) continue;
    desk_.session().practise(desk_.now(), *done);
    desk_.enter("practice", true);
    if (!desk_.attend(FeedbackStep{done->position, position}) && !desk_.goes_on()) return false;
  }
  return true;
}

std::optional<store::PracticeBody> PracticeRun::present(const PracticeProgress& at, int position,
                                                        const engine::RenderingModel& model) {
  const int number = at.done + 1;
  if (!desk_.attend(ReadyStep{number, a_round_, true})) return std::nullopt;
  if (!explore(model)) return std::nullopt;
  desk_.enter("answering", true);
  const design::SessionPlan& plan = desk_.parts().key.study.session;
  const std::optional<StepReply> reply = answer({.trial = number,
                                                 .of = a_round_,
                                                 .practice = true,
                                                 .time_is_up = false,
                                                 .may_explore_again = false,
                                                 .confidence_levels = 0,
                                                 .sight = plan.sight});
  if (!reply) return std::nullopt;
  return store::PracticeBody{at.round, number, reply->position, reply->position == position};
}

bool PracticeRun::explore(const engine::RenderingModel& model) {
  const SessionParts& parts = desk_.parts();
  desk_.enter("exploring", true);
  const Exploration done =
      parts.explorer.explore(model, textures_.plane, participant_, servo_, trace_);
  parts.clock.pass(done.lasted);
  desk_.saw_servo(done.servo);
  if (!is_interrupted(done.servo)) return true;
  const std::string reason = desk_.note_interruption(words_in_clear(done.servo));
  desk_.session().note(desk_.now(), "practice interrupted: " + reason);
  return false;
}

std::optional<StepReply> PracticeRun::answer(const AnswerStep& step) {
  std::optional<StepReply> reply = desk_.attend(step);
  if (reply) desk_.parts().clock.pass(reply->took);
  return reply;
}

}  // namespace touchtrial::session
