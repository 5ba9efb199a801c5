#include "protocols/session/session_stages.hpp"

#include "core/text.hpp"
#include "protocols/session/plane_run.hpp"
#include "protocols/session/session_desk.hpp"
#include "study/protocol.hpp"

#include <chrono>

#include <nlohmann/json.hpp>

namespace touchtrial::session {
namespace {

// Durations in virtual time only.
constexpr std::chrono::seconds kCalibration{30};
constexpr std::chrono::seconds kInstruction{120};

/// Shows a step until there is a reply, even if it is aborted.
/// \return empty if the session ended
std::optional<StepReply> show_until_reply(SessionDesk& desk, const Step& step) {
  while (desk.is_running()) {
    if (std::optional<StepReply> reply = desk.show_step(step)) return reply;
  }
  return std::nullopt;
}

// ---- Day sheet and device

std::vector<DaySheetItem> remaining_items(const SessionDesk& desk, const SessionRemarks& remarks) {
  std::vector<DaySheetItem> items;
  for (const DaySheetItem& item : desk.parts().texts.day_sheet) {
    if (!remarks.ticked.contains(item.code) && !remarks.deviations.contains(item.code)) {
      items.push_back(item);
    }
  }
  return items;
}

void record_ticks(SessionDesk& desk, const std::vector<DaySheetItem>& items,
                  const std::vector<Tick>& ticks) {
  for (std::size_t i = 0; i < items.size() && i < ticks.size(); ++i) {
    if (ticks[i] == Tick::done) {
      desk.session().tick(desk.now(), items[i].code);
    } else {
      desk.session().deviate(desk.now(), {items[i].code, "skipped on the day sheet"});
    }
  }
}

bool run_day_sheet(SessionDesk& desk) {
  const std::vector<DaySheetItem> items = remaining_items(desk, desk.session().remarks());
  if (items.empty()) return true;
  desk.enter("day sheet");
  while (desk.handle()) {
    if (const auto ticks = desk.parts().experimenter.day_sheet(items)) {
      record_ticks(desk, items, *ticks);
      return true;
    }
  }
  return false;
}

bool calibrate(SessionDesk& desk) {
  if (!run_day_sheet(desk)) return false;
  while (!desk.await_device()) {
    if (!desk.is_running()) return false;
  }
  desk.parts().clock.advance(kCalibration);
  desk.session().calibrate(desk.now());
  return true;
}

// ---- Instructions and questions

bool instruct(SessionDesk& desk) {
  desk.enter("instructions");
  const std::vector<std::string>& pages = desk.parts().texts.instructions;
  if (!pages.empty() && !show_until_reply(desk, InstructionStep{pages})) return false;
  desk.parts().clock.advance(kInstruction);
  desk.session().instruct(desk.now());
  return true;
}

nlohmann::json answer_to_json(study::QuestionKind kind, const std::string& answer) {
  if (kind == study::QuestionKind::choice) {
    if (const auto index = number_in<int>(answer)) return *index;
  }
  if (kind == study::QuestionKind::number) {
    if (const auto number = number_in<double>(answer)) return *number;
  }
  return answer;
}

/// A JSON object that maps question ids to answers, without skipped questions. Format:
/// docs/data-dictionary.md.
std::string answers_to_json(const study::Questionnaire& questionnaire,
                            const std::vector<std::string>& answers) {
  nlohmann::json object = nlohmann::json::object();
  for (std::size_t i = 0; i < questionnaire.questions.size() && i < answers.size(); ++i) {
    if (answers[i].empty()) continue;
    const study::Question& question = questionnaire.questions[i];
    object[question.id] = answer_to_json(question.kind, answers[i]);
  }
  // Typed text is stored unchanged, except that invalid UTF-8 is replaced.
  return object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// \return whether the session continues
bool ask_questionnaire(SessionDesk& desk,
                       const std::optional<study::Questionnaire>& questionnaire) {
  if (!questionnaire) return true;
  if (desk.session().remarks().questionnaires.contains(questionnaire->name)) return true;
  desk.enter("questions");
  const std::optional<StepReply> reply = show_until_reply(desk, QuestionStep{&*questionnaire});
  if (!reply) return false;
  desk.session().question(desk.time_of(*reply), questionnaire->name,
                          answers_to_json(*questionnaire, reply->answers));
  return true;
}

// ---- Practice

/// The progress of practice.
struct PracticeProgress {
  int round = 1;    ///< the current or the next round
  int done = 0;     ///< presentations in this round
  int correct = 0;  ///< correct answers in this round
  bool passed = false;
};

/// \param practised  recorded practice, in chronological order
/// \param plan  any round; all have the same number of trials
PracticeProgress progress_of(const std::vector<record::PracticeBody>& practised,
                             const study::Practice& plan) {
  PracticeProgress progress;
  for (const record::PracticeBody& presentation : practised) {
    if (presentation.round > progress.round) progress = {.round = presentation.round};
    ++progress.done;
    progress.correct += presentation.correct.value_or(false) ? 1 : 0;
  }
  const bool is_round_complete = progress.done >= std::ssize(plan.trials);
  progress.passed = plan.criterion > 0 ? progress.correct >= plan.criterion : is_round_complete;
  if (!progress.passed && is_round_complete) progress = {.round = progress.round + 1};
  return progress;
}

/// Runs practice with feedback, until enough answers of a round are correct. Continues after
/// recorded practice, which may be from an earlier run of the program.
class PracticeRun {
 public:
  explicit PracticeRun(SessionDesk& desk)
      : desk_(desk),
        plan_(desk.parts().practice(1)),
        trials_per_round_(static_cast<int>(plan_.trials.size())) {}

  /// \return whether the session continues
  [[nodiscard]] bool run();

 private:
  [[nodiscard]] PracticeProgress progress() const {
    return progress_of(desk_.session().remarks().practice, plan_);
  }
  [[nodiscard]] bool run_round(int round);
  /// \return empty if the presentation was interrupted, and must be repeated if the session
  ///   continues
  [[nodiscard]] std::optional<record::PracticeBody> present(const PracticeProgress& state,
                                                            const study::Trial& trial);
  /// \return the end of the exploration; empty if it was interrupted
  [[nodiscard]] std::optional<device::ServoEnd> explore(const study::Trial& trial);

  SessionDesk& desk_;
  study::Practice plan_;
  record::Trace trace_;
  int trials_per_round_;
  int not_explored_ = 0;  ///< trials with a plane that was not explored as instructed
};

bool PracticeRun::run() {
  for (PracticeProgress state = progress(); !state.passed; state = progress()) {
    if (state.round > plan_.rounds || not_explored_ > trials_per_round_) {
      if (!desk_.session().remarks().deviations.contains("practice-not-passed")) {
        desk_.session().deviate(desk_.now(), {"practice-not-passed", ""});
      }
      return true;
    }
    if (!run_round(state.round)) return false;
  }
  return true;
}

bool PracticeRun::run_round(int round) {
  const study::Practice practice = desk_.parts().practice(round);
  desk_.parts().participant.see_pictures(practice.labels);
  desk_.enter_practice("practice", 0, trials_per_round_);
  if (!desk_.show_step(PracticeStep{round})) return desk_.is_running();
  for (PracticeProgress state = progress(); state.round == round && !state.passed;
       state = progress()) {
    if (not_explored_ > trials_per_round_) return true;
    if (!desk_.await_device()) {
      if (!desk_.is_running()) return false;
      continue;
    }
    const study::Trial& trial =
        practice.trials[static_cast<std::size_t>(state.done) % practice.trials.size()];
    const std::optional<record::PracticeBody> presented = present(state, trial);
    if (!desk_.is_running()) return false;
    if (!presented) continue;
    desk_.session().practise(desk_.now(), *presented);
    if (!trial.right) continue;
    desk_.enter_practice("feedback", presented->presentation, trials_per_round_);
    const int answered_position = position_of(presented->answer).value_or(0);
    if (!desk_.show_step(FeedbackStep{answered_position, *trial.right}) && !desk_.is_running())
      return false;
  }
  return true;
}

std::optional<record::PracticeBody> PracticeRun::present(const PracticeProgress& state,
                                                         const study::Trial& trial) {
  const int number = state.done + 1;
  desk_.enter_practice("ready", number, trials_per_round_);
  if (!desk_.show_step(ReadyStep{number, trials_per_round_, true})) return std::nullopt;
  desk_.enter_practice("exploring", number, trials_per_round_);
  const std::optional<device::ServoEnd> end = explore(trial);
  if (!end) return std::nullopt;
  desk_.enter_practice("answering", number, trials_per_round_);
  const study::Study& study = desk_.parts().key.study;
  const std::optional<StepReply> reply =
      desk_.show_step(AnswerStep{.trial = number,
                                 .total = trials_per_round_,
                                 .practice = true,
                                 .time_is_up = *end == device::ServoEnd::time_limit,
                                 .question = study.task->ask(study, trial.place).question,
                                 .picture = study::picture_of(study, trial),
                                 .sight = study.session.sight});
  if (!reply) return std::nullopt;
  record::PracticeBody body{state.round, number, reply->answer, std::nullopt};
  if (trial.right) body.correct = position_of(reply->answer) == trial.right;
  return body;
}

std::optional<device::ServoEnd> PracticeRun::explore(const study::Trial& trial) {
  device::ServoReport last_report;
  const PlaneListener listener{
      [this] { return &trace_; },
      [&last_report](const Exploration& exploration) { last_report = exploration.servo; }};
  switch (run_planes(desk_, trial, desk_.servo_options(), listener)) {
    case PlanesEnd::explored:
    case PlanesEnd::time_is_up:
      return last_report.end;
    case PlanesEnd::interrupted:
      desk_.session().note(desk_.now(),
                           "practice interrupted: " + desk_.note_interruption(last_report));
      return std::nullopt;
    case PlanesEnd::not_explored:
      ++not_explored_;
      desk_.enter_practice("not explored", trial.place.trial, trials_per_round_);
      static_cast<void>(desk_.show_step(
          NoticeStep{NoticeStep::What::not_explored, desk_.session().presentations_begun()}));
      return std::nullopt;
    case PlanesEnd::paused:
    case PlanesEnd::aborted:
      break;
  }
  return std::nullopt;
}

/// \return whether the session continues
bool practise(SessionDesk& desk) {
  const auto& practice = desk.parts().practice;
  const bool has_practice = practice && !practice(1).trials.empty();
  if (!has_practice || desk.session().presentations_begun() > 0) return true;
  const std::size_t recorded_count = desk.session().remarks().practice.size();
  if (!PracticeRun(desk).run()) return false;
  if (desk.session().remarks().practice.size() == recorded_count)
    return true;  // practice was already over
  desk.enter("practice is over");
  return show_until_reply(desk, NoticeStep{NoticeStep::What::practice_over}).has_value();
}

void show_pictures(SessionDesk& desk) {
  const study::Study& study = desk.parts().key.study;
  const std::vector<study::Choice> choices = study::choices_of(study);
  std::vector<std::string> pictures;
  for (const int choice : desk.session().layout()) {
    pictures.push_back(choices[static_cast<std::size_t>(choice)].label);
  }
  desk.parts().participant.see_pictures(pictures);
}

}  // namespace

bool run_opening_stages(SessionDesk& desk) {
  const Session& session = desk.session();
  if (session.phase() == SessionPhase::opened && !calibrate(desk)) return false;
  if (session.phase() == SessionPhase::calibrated && !instruct(desk)) return false;
  if (session.phase() == SessionPhase::ready) {
    if (!ask_questionnaire(desk, desk.parts().texts.handedness) || !practise(desk)) return false;
    show_pictures(desk);
  }
  return desk.is_running();
}

void ask_closing_questions(SessionDesk& desk) {
  // If this is interrupted, the questions are skipped, because the trials are already stored.
  static_cast<void>(ask_questionnaire(desk, desk.parts().texts.closing));
}

}  // namespace touchtrial::session
