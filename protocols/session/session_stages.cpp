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

/// Shows a step again whenever it is aborted.
/// \return empty if the session ended
std::optional<StepReply> attend_until_reply(SessionDesk& desk, const Step& step) {
  while (desk.is_running()) {
    if (std::optional<StepReply> reply = desk.attend(step)) return reply;
  }
  return std::nullopt;
}

// ---- Day sheet and device

std::vector<DaySheetItem> open_items(const SessionDesk& desk, const SessionRemarks& remarks) {
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

bool go_through_day_sheet(SessionDesk& desk) {
  const std::vector<DaySheetItem> items = open_items(desk, desk.session().remarks());
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
  if (!go_through_day_sheet(desk)) return false;
  while (!desk.await_device()) {
    if (!desk.is_running()) return false;
  }
  desk.parts().clock.pass(kCalibration);
  desk.session().calibrate(desk.now());
  return true;
}

// ---- Instructions and questions

bool instruct(SessionDesk& desk) {
  desk.enter("instructions");
  const std::vector<std::string>& pages = desk.parts().texts.instructions;
  if (!pages.empty() && !attend_until_reply(desk, InstructionStep{pages})) return false;
  desk.parts().clock.pass(kInstruction);
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
bool ask(SessionDesk& desk, const std::optional<study::Questionnaire>& questionnaire) {
  if (!questionnaire) return true;
  if (desk.session().remarks().questionnaires.contains(questionnaire->name)) return true;
  desk.enter("questions");
  const std::optional<StepReply> reply = attend_until_reply(desk, QuestionStep{&*questionnaire});
  if (!reply) return false;
  desk.session().question(desk.when(*reply), questionnaire->name,
                          answers_to_json(*questionnaire, reply->answers));
  return true;
}

// ---- Practice

/// The progress of practice.
struct PracticeProgress {
  int round = 1;    ///< the current or the next one
  int done = 0;     ///< presentations of that round
  int correct = 0;  ///< of these
  bool passed = false;
};

/// \param practised  recorded practice, in chronological order
/// \param plan  any round; all have the same number of trials
PracticeProgress progress_of(const std::vector<record::PracticeBody>& practised,
                             const study::Practice& plan) {
  PracticeProgress progress;
  for (const record::PracticeBody& one : practised) {
    if (one.round > progress.round) progress = {.round = one.round};
    ++progress.done;
    progress.correct += one.correct.value_or(false) ? 1 : 0;
  }
  const bool is_whole = progress.done >= std::ssize(plan.trials);
  progress.passed = plan.criterion > 0 ? progress.correct >= plan.criterion : is_whole;
  if (!progress.passed && is_whole) progress = {.round = progress.round + 1};
  return progress;
}

/// Practice with feedback, until enough answers of a round are correct. Continues after recorded
/// practice, which may be from an earlier run of the program.
class PracticeRun {
 public:
  explicit PracticeRun(SessionDesk& desk)
      : desk_(desk),
        plan_(desk.parts().practice(1)),
        a_round_(static_cast<int>(plan_.trials.size())) {}

  /// \return whether the session continues
  [[nodiscard]] bool run();

 private:
  [[nodiscard]] PracticeProgress progress() const {
    return progress_of(desk_.session().remarks().practice, plan_);
  }
  [[nodiscard]] bool run_round(int round);
  /// \return empty if the presentation was interrupted, and must be repeated if the session continues
  [[nodiscard]] std::optional<record::PracticeBody> present(const PracticeProgress& at,
                                                            const study::Trial& trial);
  /// \return how the exploration ended; empty if it was interrupted
  [[nodiscard]] std::optional<device::ServoEnd> explore(const study::Trial& trial);

  SessionDesk& desk_;
  study::Practice plan_;
  record::Trace trace_;
  int a_round_;
  int not_explored_ = 0;  ///< trials with a plane that was not explored as instructed
};

bool PracticeRun::run() {
  for (PracticeProgress at = progress(); !at.passed; at = progress()) {
    if (at.round > plan_.rounds || not_explored_ > a_round_) {
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
  const study::Practice shown = desk_.parts().practice(round);
  desk_.parts().participant.see_pictures(shown.labels);
  desk_.enter_practice("practice", 0, a_round_);
  if (!desk_.attend(PracticeStep{round})) return desk_.is_running();
  for (PracticeProgress at = progress(); at.round == round && !at.passed; at = progress()) {
    if (not_explored_ > a_round_) return true;
    if (!desk_.await_device()) {
      if (!desk_.is_running()) return false;
      continue;
    }
    const study::Trial& trial =
        shown.trials[static_cast<std::size_t>(at.done) % shown.trials.size()];
    const std::optional<record::PracticeBody> done = present(at, trial);
    if (!desk_.is_running()) return false;
    if (!done) continue;
    desk_.session().practise(desk_.now(), *done);
    if (!trial.right) continue;
    desk_.enter_practice("feedback", done->presentation, a_round_);
    const int answered = position_of(done->answer).value_or(0);
    if (!desk_.attend(FeedbackStep{answered, *trial.right}) && !desk_.is_running()) return false;
  }
  return true;
}

std::optional<record::PracticeBody> PracticeRun::present(const PracticeProgress& at,
                                                         const study::Trial& trial) {
  const int number = at.done + 1;
  desk_.enter_practice("ready", number, a_round_);
  if (!desk_.attend(ReadyStep{number, a_round_, true})) return std::nullopt;
  desk_.enter_practice("exploring", number, a_round_);
  const std::optional<device::ServoEnd> end = explore(trial);
  if (!end) return std::nullopt;
  desk_.enter_practice("answering", number, a_round_);
  const study::Study& study = desk_.parts().key.study;
  const std::optional<StepReply> reply =
      desk_.attend(AnswerStep{.trial = number,
                              .of = a_round_,
                              .practice = true,
                              .time_is_up = *end == device::ServoEnd::time_limit,
                              .question = study.task->ask(study, trial.place).question,
                              .picture = study::picture_of(study, trial),
                              .sight = study.session.sight});
  if (!reply) return std::nullopt;
  record::PracticeBody body{at.round, number, reply->answer, std::nullopt};
  if (trial.right) body.correct = position_of(reply->answer) == trial.right;
  return body;
}

std::optional<device::ServoEnd> PracticeRun::explore(const study::Trial& trial) {
  device::ServoReport last;
  const PlaneListener listener{[this] { return &trace_; },
                               [&last](const Exploration& done) { last = done.servo; }};
  switch (run_planes(desk_, trial, desk_.servo_options(), listener)) {
    case PlanesEnd::explored:
    case PlanesEnd::time_is_up:
      return last.end;
    case PlanesEnd::interrupted:
      desk_.session().note(desk_.now(), "practice interrupted: " + desk_.note_interruption(last));
      return std::nullopt;
    case PlanesEnd::not_explored:
      ++not_explored_;
      desk_.enter_practice("not explored", trial.place.trial, a_round_);
      static_cast<void>(desk_.attend(
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
  const bool wanted = practice && !practice(1).trials.empty();
  if (!wanted || desk.session().presentations_begun() > 0) return true;
  const std::size_t before = desk.session().remarks().practice.size();
  if (!PracticeRun(desk).run()) return false;
  if (desk.session().remarks().practice.size() == before) return true;  // practice was already over
  desk.enter("practice is over");
  return attend_until_reply(desk, NoticeStep{NoticeStep::What::practice_over}).has_value();
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
    if (!ask(desk, desk.parts().texts.handedness) || !practise(desk)) return false;
    show_pictures(desk);
  }
  return desk.is_running();
}

void ask_closing_questions(SessionDesk& desk) {
  // If this is interrupted, the questions are skipped, because the trials are already stored.
  static_cast<void>(ask(desk, desk.parts().texts.closing));
}

}  // namespace touchtrial::session
