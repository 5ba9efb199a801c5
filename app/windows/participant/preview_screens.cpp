#include "app/windows/participant/preview_screens.hpp"

#include "study/protocol.hpp"

#include <algorithm>
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
  /// One of a trial's planes, and what is said before it.
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

/// Whether the device is only heard in some trials.
bool has_hand_off(const study::Study& study) {
  return std::ranges::any_of(study.protocol->schedule(study, {}).presentations,
                             &study::Presentation::hand_off);
}

void add_interval_practice(ScreenList& list, const study::Study& study,
                           const study::IntervalPlan& plan) {
  const int of = static_cast<int>(study.protocol->practice_trials(study, {}, 1).size());
  if (of == 0 || plan.practice_rounds == 0) return;
  list.set_practice(true);
  list.add("practice", session::PracticeStep{1});
  list.add("practice-ready", session::ReadyStep{1, of, true});
  list.add_interval("practice-interval", "practice-explore",
                    {.trial = 1, .practice = true, .interval = 1, .of = plan.count});
  list.add("practice-answer", session::AnswerStep{.trial = 1,
                                                  .of = of,
                                                  .practice = true,
                                                  .question = plan.question,
                                                  .sight = study.session.sight});
  list.add("practice-right", session::FeedbackStep{0, 0});
  list.add("practice-wrong", session::FeedbackStep{0, 1});
  if (plan.practice_rounds > 1) list.add("practice-again", session::PracticeStep{2});
  list.set_practice(false);
  list.add("practice-over", session::NoticeStep{session::NoticeStep::What::practice_over});
}

/// The keys that choose and go on, to the scale of confidence.
std::vector<InputEvent> keys_to_confidence() {
  return {pressed_key(Key::digit, 1), pressed_key(Key::enter)};
}

void add_interval_trials(ScreenList& list, const study::Study& study,
                         const study::IntervalPlan& plan, int of) {
  using What = session::NoticeStep::What;
  session::IntervalStep next{.trial = 1, .interval = 1, .of = plan.count};
  list.add("ready", session::ReadyStep{1, of, false});
  list.add_interval("interval", "explore", next);
  const session::AnswerStep answer{.trial = 1,
                                   .of = of,
                                   .confidence_levels = study.session.confidence_levels,
                                   .question = plan.question,
                                   .sight = study.session.sight};
  list.add("answer", answer);
  if (answer.confidence_levels > 0 && answer.sight != study::Sight::blindfold) {
    list.add("confidence", answer, keys_to_confidence());
  }
  if (plan.feedback) {
    list.add("right", session::FeedbackStep{0, 0});
    list.add("wrong", session::FeedbackStep{0, 1});
  }
  list.add("not-explored", session::NoticeStep{What::not_explored});
  if (!has_hand_off(study)) return;
  next.hand_off = true;
  list.add("hand-off", session::NoticeStep{What::hand_off});
  list.add("hand-off-ready", session::ReadyStep{of, of, false, true});
  list.add_interval("hand-off-interval", "hand-off-explore", next);
}

void add_practice_screens(ScreenList& list, const study::Study& study) {
  if (study.trials.practice == 0) return;
  const int of = study.trials.practice;
  const study::Sight sight = study.session.sight;
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

void add_trial_screens(ScreenList& list, const study::Study& study, int of) {
  list.add("ready", session::ReadyStep{1, of, false});
  list.add_plane("explore");
  session::AnswerStep answer{.trial = 1,
                             .of = of,
                             .may_explore_again = true,
                             .confidence_levels = study.session.confidence_levels,
                             .sight = study.session.sight};
  const bool is_asked =
      answer.confidence_levels > 0 && study.session.sight != study::Sight::blindfold;
  list.add("answer", answer);
  if (is_asked) list.add("confidence", answer, keys_to_confidence());
  if (study.trials.on_timeout == study::OnTimeout::fade) {
    answer.time_is_up = true;
    answer.may_explore_again = false;
    list.add("time-up", answer);
  } else {
    list.add("time-up", session::NoticeStep{session::NoticeStep::What::time_is_up});
  }
}

/// \param of  trials of a session
void add_interruptions(ScreenList& list, const study::TrialOptions& plan, int of) {
  if (plan.break_every > 0 || plan.break_after_min > 0.0) {
    list.add("break", session::BreakStep{plan.break_every > 0 ? plan.break_every : of / 2, of});
  }
  list.add("stopped",
           session::NoticeStep{.what = session::NoticeStep::What::stopped, .may_go_on = false});
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
  if (const auto plan = study.protocol->interval_plan(study)) {
    const int of = static_cast<int>(study.protocol->schedule(study, {}).presentations.size());
    add_interval_practice(list, study, *plan);
    add_interval_trials(list, study, *plan, of);
    add_interruptions(list, study.trials, of);
  } else {
    const int of = study.scored_trials() + study.trials.catch_trials;
    add_practice_screens(list, study);
    add_trial_screens(list, study, of);
    add_interruptions(list, study.trials, of);
  }
  list.add_questions("closing", texts.closing);
  list.add("thanks", session::EndStep{});
  return list.take();
}

std::vector<std::string> preview_labels(const study::Study& study, const PreviewScreen& screen) {
  std::vector<std::string> labels;
  if (study.protocol->interval_plan(study)) {
    for (const study::Choice& choice : study.protocol->choices(study)) {
      labels.push_back(choice.label);
    }
    return labels;
  }
  for (const study::StudyClass& shown : screen.practice ? study.practice.classes : study.classes) {
    labels.push_back(shown.label);
  }
  return labels;
}

}  // namespace touchtrial::app
