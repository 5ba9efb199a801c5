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
  /// \param keys  that lead to it from the step's first page
  void add(const std::string& name, const session::Step& step,
           const std::vector<InputEvent>& keys = {}) {
    screens_.push_back({name, step, keys, practice_});
  }
  void add_plane(const std::string& name) {
    screens_.push_back({name, std::nullopt, {}, practice_});
  }
  /// One of a trial's planes, and its announcement.
  void add_interval(const std::string& announced, const std::string& explored,
                    const session::IntervalStep& step) {
    add(announced, step);
    add_plane(explored);
    screens_.back().interval = step;
  }
  /// A step of several pages.
  /// \param leave  the keys that leave each page
  void add_pages(const std::string& name, const session::Step& step,
                 const std::vector<std::vector<InputEvent>>& leave) {
    std::vector<InputEvent> keys;
    for (std::size_t page = 0; page < leave.size(); ++page) {
      add(page == 0 ? name : name + "-" + std::to_string(page + 1), step, keys);
      keys.insert(keys.end(), leave[page].begin(), leave[page].end());
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

/// A required question gets the first option, or a 1.
void ScreenList::add_questions(const std::string& name,
                               const std::optional<study::Questionnaire>& questionnaire) {
  if (!questionnaire) return;
  std::vector<std::vector<InputEvent>> leave;
  for (const study::Question& question : questionnaire->questions) {
    std::vector<InputEvent>& keys = leave.emplace_back();
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
  add_pages(name, session::QuestionStep{&*questionnaire}, leave);
}

/// The keys from the choice to the confidence scale.
std::vector<InputEvent> keys_to_confidence() {
  return {pressed_key(Key::digit, 1), pressed_key(Key::enter)};
}

/// The label of the picture that is shown with ratings; empty: none.
/// \param class_index  practice classes follow the study's
std::string rated_picture(const study::Study& study, const study::Ask& ask, int class_index) {
  if (!std::holds_alternative<study::Rate>(ask.question)) return "";
  return study::picture_of(study, {.picture = class_index});
}

/// A trial's planes, with announcements if there are several.
/// \param prefix  of the screens' names
void add_planes(ScreenList& list, const study::Ask& ask, const std::string& prefix,
                session::IntervalStep next) {
  if (ask.planes == 1) return list.add_plane(prefix + "explore");
  next.of = ask.planes;
  list.add_interval(prefix + "interval", prefix + "explore", next);
}

void add_practice(ScreenList& list, const study::Study& study, const study::Ask& ask) {
  const study::Practice practice = study::practice_of(study);
  const int of = static_cast<int>(practice.trials.size());
  if (of == 0 || practice.rounds == 0) return;
  list.set_practice(true);
  list.add("practice", session::PracticeStep{1});
  list.add("practice-ready", session::ReadyStep{1, of, true});
  add_planes(list, ask, "practice-", {.trial = 1, .practice = true});
  list.add("practice-answer",
           session::AnswerStep{
               .trial = 1,
               .of = of,
               .practice = true,
               .question = ask.question,
               .picture = rated_picture(study, ask, static_cast<int>(study.classes.size())),
               .sight = study.session.sight});
  if (practice.trials.front().right) {
    list.add("practice-right", session::FeedbackStep{0, 0});
    list.add("practice-wrong", session::FeedbackStep{0, 1});
  }
  if (practice.rounds > 1) list.add("practice-again", session::PracticeStep{2});
  list.set_practice(false);
  list.add("practice-over", session::NoticeStep{session::NoticeStep::What::practice_over});
}

void add_trial(ScreenList& list, const study::Study& study, const study::Ask& ask, int of) {
  const bool is_free = std::holds_alternative<study::Free>(ask.exploring);
  list.add("ready", session::ReadyStep{1, of, false});
  add_planes(list, ask, "", {.trial = 1});
  session::AnswerStep answer{.trial = 1,
                             .of = of,
                             .may_explore_again = is_free && ask.planes == 1,
                             .confidence_levels = ask.confidence_levels,
                             .question = ask.question,
                             .picture = rated_picture(study, ask, 0),
                             .sight = study.session.sight};
  list.add("answer", answer);
  if (answer.confidence_levels > 0 && answer.sight != study::Sight::blindfold) {
    list.add("confidence", answer, keys_to_confidence());
  }
  if (ask.feedback) {
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

/// A trial in which the device can only be heard, if the study has any.
void add_hand_off(ScreenList& list, const study::Schedule& schedule, const study::Ask& ask) {
  const auto is_heard = [](const study::Trial& trial) { return trial.place.hand_off; };
  if (!std::ranges::any_of(schedule.trials, is_heard)) return;
  const int of = static_cast<int>(schedule.trials.size());
  list.add("hand-off", session::NoticeStep{session::NoticeStep::What::hand_off});
  list.add("hand-off-ready", session::ReadyStep{of, of, false, true});
  add_planes(list, ask, "hand-off-", {.trial = 1, .hand_off = true});
}

/// \param of  trials of a session
void add_interruptions(ScreenList& list, const study::TrialOptions& plan, int of) {
  if (plan.break_every > 0 || plan.break_after_min > 0.0) {
    list.add("break", session::BreakStep{plan.break_every > 0 ? plan.break_every : of / 2, of});
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
  const study::Ask ask = study::ask_of(study);
  const study::Schedule schedule = study::make_schedule(study, {});
  const int of = static_cast<int>(schedule.trials.size());
  add_practice(list, study, ask);
  add_trial(list, study, ask, of);
  add_hand_off(list, schedule, ask);
  add_interruptions(list, study.trials, of);
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
