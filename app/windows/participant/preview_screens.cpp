#include "app/windows/participant/preview_screens.hpp"

#include "study/protocol.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace touchtrial::app {
namespace {

InputEvent pressed_key(Key key, int digit = 0) {
  InputEvent event;
  event.key = key;
  event.digit = digit;
  return event;
}

/// Adds screens in their order.
class ScreenList {
 public:
  /// \param keys  the keys that lead from the step's first page to the screen
  void add(const std::string& name, const session::Step& step,
           const std::vector<InputEvent>& keys = {}) {
    screens_.push_back({name, step, keys, practice_});
  }
  void add_plane(const std::string& name) {
    screens_.push_back({name, std::nullopt, {}, practice_});
  }
  /// Adds one of a trial's planes, and its announcement.
  void add_interval(const std::string& interval_name, const std::string& plane_name,
                    const session::IntervalStep& step) {
    add(interval_name, step);
    add_plane(plane_name);
    screens_.back().interval = step;
  }
  /// Adds the pages of a step.
  /// \param keys_to_leave  the keys that end each page
  void add_pages(const std::string& name, const session::Step& step,
                 const std::vector<std::vector<InputEvent>>& keys_to_leave) {
    std::vector<InputEvent> keys;
    for (std::size_t page = 0; page < keys_to_leave.size(); ++page) {
      add(page == 0 ? name : name + "-" + std::to_string(page + 1), step, keys);
      keys.insert(keys.end(), keys_to_leave[page].begin(), keys_to_leave[page].end());
    }
  }
  void add_questions(const std::string& name,
                     const std::optional<study::Questionnaire>& questionnaire);
  void set_practice(bool practice) { practice_ = practice; }
  [[nodiscard]] std::vector<PreviewScreen> take() { return std::move(screens_); }

 private:
  std::vector<PreviewScreen> screens_;
  bool practice_ = false;
};

/// Adds the pages of a questionnaire. A required question is answered with its first option, or 1.
void ScreenList::add_questions(const std::string& name,
                               const std::optional<study::Questionnaire>& questionnaire) {
  if (!questionnaire) return;
  std::vector<std::vector<InputEvent>> keys_to_leave;
  for (const study::Question& question : questionnaire->questions) {
    std::vector<InputEvent>& keys = keys_to_leave.emplace_back();
    if (question.required && question.kind == study::QuestionKind::choice) {
      keys.push_back(pressed_key(Key::digit, 1));
    } else if (question.required) {
      InputEvent letter;
      letter.kind = InputEvent::Kind::letter;
      letter.letter = U'1';
      keys.push_back(letter);
    }
    keys.push_back(pressed_key(Key::enter));
  }
  add_pages(name, session::QuestionStep{&*questionnaire}, keys_to_leave);
}

/// The keys that lead from the choice to the confidence scale.
std::vector<InputEvent> keys_to_confidence() {
  return {pressed_key(Key::digit, 1), pressed_key(Key::enter)};
}

/// The label of the picture that is shown with ratings; empty: none.
/// \param class_index  practice classes follow the study's
std::string rated_picture(const study::Study& study, const study::TrialQuestion& trial_question,
                          int class_index) {
  if (!std::holds_alternative<study::RatingQuestion>(trial_question.question)) return "";
  return study::picture_of(study, {.picture = class_index});
}

/// Adds a trial's planes, with announcements if there are several.
/// \param prefix  prefix of the screens' names
void add_planes(ScreenList& list, const study::TrialQuestion& trial_question,
                const std::string& prefix, session::IntervalStep next) {
  if (trial_question.planes == 1) return list.add_plane(prefix + "explore");
  next.total = trial_question.planes;
  list.add_interval(prefix + "interval", prefix + "explore", next);
}

void add_practice(ScreenList& list, const study::Study& study,
                  const study::TrialQuestion& trial_question) {
  const study::Practice practice = study::practice_of(study);
  const int trial_count = static_cast<int>(practice.trials.size());
  if (trial_count == 0 || practice.rounds == 0) return;
  list.set_practice(true);
  list.add("practice", session::PracticeStep{1});
  list.add("practice-ready", session::ReadyStep{1, trial_count, true});
  add_planes(list, trial_question, "practice-", {.trial = 1, .practice = true});
  list.add("practice-answer",
           session::AnswerStep{.trial = 1,
                               .total = trial_count,
                               .practice = true,
                               .question = trial_question.question,
                               .picture = rated_picture(study, trial_question,
                                                        static_cast<int>(study.classes.size())),
                               .sight = study.session.sight});
  if (practice.trials.front().right) {
    list.add("practice-right", session::FeedbackStep{0, 0});
    list.add("practice-wrong", session::FeedbackStep{0, 1});
  }
  if (practice.rounds > 1) list.add("practice-again", session::PracticeStep{2});
  list.set_practice(false);
  list.add("practice-over", session::NoticeStep{session::NoticeStep::What::practice_over});
}

void add_trial(ScreenList& list, const study::Study& study,
               const study::TrialQuestion& trial_question, int trial_count) {
  const bool is_free = std::holds_alternative<study::FreeExploration>(trial_question.exploring);
  list.add("ready", session::ReadyStep{1, trial_count, false});
  add_planes(list, trial_question, "", {.trial = 1});
  session::AnswerStep answer{.trial = 1,
                             .total = trial_count,
                             .may_explore_again = is_free && trial_question.planes == 1,
                             .confidence_levels = trial_question.confidence_levels,
                             .question = trial_question.question,
                             .picture = rated_picture(study, trial_question, 0),
                             .sight = study.session.sight};
  list.add("answer", answer);
  if (answer.confidence_levels > 0 && answer.sight != study::Sight::blindfold) {
    list.add("confidence", answer, keys_to_confidence());
  }
  if (trial_question.feedback) {
    list.add("right", session::FeedbackStep{0, 0});
    list.add("wrong", session::FeedbackStep{0, 1});
  }
  if (!is_free) {
    list.add("not-explored", session::NoticeStep{session::NoticeStep::What::not_explored});
  } else if (study.trials.on_timeout == study::OnTimeout::fade) {
    answer.time_is_up = true;
    answer.may_explore_again = false;
    list.add("time-up", answer);
  } else {
    list.add("time-up", session::NoticeStep{session::NoticeStep::What::time_is_up});
  }
}

/// Adds a trial with the hand off the device, if the study has any.
void add_hand_off(ScreenList& list, const study::Schedule& schedule,
                  const study::TrialQuestion& trial_question) {
  const auto is_hand_off = [](const study::Trial& trial) { return trial.place.hand_off; };
  if (!std::ranges::any_of(schedule.trials, is_hand_off)) return;
  const int trial_count = static_cast<int>(schedule.trials.size());
  list.add("hand-off", session::NoticeStep{session::NoticeStep::What::hand_off});
  list.add("hand-off-ready", session::ReadyStep{trial_count, trial_count, false, true});
  add_planes(list, trial_question, "hand-off-", {.trial = 1, .hand_off = true});
}

/// \param trial_count  number of trials of a session
void add_interruptions(ScreenList& list, const study::TrialOptions& plan, int trial_count) {
  if (plan.break_every > 0 || plan.break_after_min > 0.0) {
    list.add("break", session::BreakStep{plan.break_every > 0 ? plan.break_every : trial_count / 2,
                                         trial_count});
  }
  list.add("stopped",
           session::NoticeStep{.what = session::NoticeStep::What::stopped, .can_resume = false});
  list.add("pause", session::PauseStep{});
}

}  // namespace

std::vector<PreviewScreen> preview_screens(const study::Study& study,
                                           const session::SessionTexts& texts) {
  ScreenList list;
  list.add_pages(
      "welcome", session::InstructionStep{texts.instructions},
      std::vector<std::vector<InputEvent>>(texts.instructions.size(), {pressed_key(Key::enter)}));
  list.add_questions("handedness", texts.handedness);
  const study::TrialQuestion trial_question = study::trial_question_of(study);
  const study::Schedule schedule = study::make_schedule(study, {});
  const int trial_count = static_cast<int>(schedule.trials.size());
  add_practice(list, study, trial_question);
  add_trial(list, study, trial_question, trial_count);
  add_hand_off(list, schedule, trial_question);
  add_interruptions(list, study.trials, trial_count);
  list.add_questions("closing", texts.closing);
  list.add("thanks", session::EndStep{});
  return list.take();
}

std::vector<std::string> preview_labels(const study::Study& study, const PreviewScreen& screen) {
  if (screen.practice) return study::practice_of(study).labels;
  std::vector<std::string> labels;
  for (const study::Choice& choice : study::choices_of(study)) labels.push_back(choice.label);
  return labels;
}

}  // namespace touchtrial::app
