#include "app/participant/preview_screens.hpp"

#include <utility>

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
  /// \param keys  lead to it from the step's first page
  void add(const std::string& name, const session::Step& step,
           const std::vector<InputEvent>& keys = {}) {
    screens_.push_back({name, step, keys, practice_});
  }
  void add_plane(const std::string& name) {
    screens_.push_back({name, std::nullopt, {}, practice_});
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
                     const std::optional<design::Questionnaire>& questionnaire);
  void set_practice(bool practice) { practice_ = practice; }
  [[nodiscard]] std::vector<PreviewScreen> take() { return std::move(screens_); }

 private:
  std::vector<PreviewScreen> screens_;
  bool practice_ = false;
};

/// A required question gets the first option, or a 1.
void ScreenList::add_questions(const std::string& name,
                               const std::optional<design::Questionnaire>& questionnaire) {
  if (!questionnaire) return;
  std::vector<std::vector<InputEvent>> leave;
  for (const design::Question& question : questionnaire->questions) {
    std::vector<InputEvent>& keys = leave.emplace_back();
    if (question.required && question.kind == design::QuestionKind::choice) {
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

void add_practice_screens(ScreenList& list, const design::Study& study) {
  if (study.trials.practice == 0) return;
  const int of = study.trials.practice;
  const design::Sight sight = study.session.sight;
  list.set_practice(true);
  list.add("practice", session::PracticeStep{1});
  list.add("practice-ready", session::ReadyStep{1, of, true});
  list.add_plane("practice-explore");
  list.add("practice-answer",
           session::AnswerStep{.trial = 1, .of = of, .practice = true, .sight = sight});
  list.add("practice-right", session::FeedbackStep{0, 0});
  list.add("practice-wrong", session::FeedbackStep{0, 1});
  if (study.practice.rounds > 1) list.add("practice-again", session::PracticeStep{2});
  list.set_practice(false);
  list.add("practice-over", session::NoticeStep{session::NoticeStep::What::practice_over});
}

void add_trial_screens(ScreenList& list, const design::Study& study) {
  const int of = study.scored_trials() + study.trials.catch_trials;
  list.add("ready", session::ReadyStep{1, of, false});
  list.add_plane("explore");
  session::AnswerStep answer{.trial = 1,
                             .of = of,
                             .may_explore_again = true,
                             .confidence_levels = study.session.confidence_levels,
                             .sight = study.session.sight};
  const bool is_asked =
      answer.confidence_levels > 0 && study.session.sight != design::Sight::blindfold;
  const std::vector<InputEvent> choose = {pressed_key(Key::digit, 1), pressed_key(Key::enter)};
  list.add("answer", answer);
  if (is_asked) list.add("confidence", answer, choose);
  if (study.trials.on_timeout == design::OnTimeout::fade) {
    answer.time_is_up = true;
    answer.may_explore_again = false;
    list.add("time-up", answer);
  } else {
    list.add("time-up", session::NoticeStep{session::NoticeStep::What::time_is_up});
  }
  if (study.trials.break_every > 0) {
    list.add("break", session::BreakStep{study.trials.break_every, of});
  }
  list.add("stopped",
           session::NoticeStep{.what = session::NoticeStep::What::stopped, .may_go_on = false});
  list.add("pause", session::PauseStep{});
}

}  // namespace

std::vector<PreviewScreen> preview_screens(const design::Study& study,
                                           const session::SessionTexts& texts) {
  ScreenList list;
  list.add_pages(
      "welcome", session::InstructionStep{texts.instructions},
      std::vector<std::vector<InputEvent>>(texts.instructions.size(), {pressed_key(Key::enter)}));
  list.add_questions("handedness", texts.handedness);
  add_practice_screens(list, study);
  add_trial_screens(list, study);
  list.add_questions("closing", texts.closing);
  list.add("thanks", session::EndStep{});
  return list.take();
}

std::vector<std::string> preview_labels(const design::Study& study, const PreviewScreen& screen) {
  std::vector<std::string> labels;
  for (const design::StudyClass& shown : screen.practice ? study.practice.classes : study.classes) {
    labels.push_back(shown.label);
  }
  return labels;
}

}  // namespace touchtrial::app
