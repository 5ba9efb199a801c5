#include "app/participant/answer_screen.hpp"
#include "app/participant/feedback_screen.hpp"
#include "app/participant/question_screen.hpp"
#include "app/participant/screen.hpp"
#include "app/participant/simple_screens.hpp"

#include <type_traits>
#include <utility>

namespace touchtrial::app {
namespace {

using Made = std::shared_ptr<Screen>;

/// A screen for each kind of step.
class Maker {
 public:
  Maker(const ScreenContext& context, const std::vector<std::string>& labels)
      : context_(context), words_(*context.words), labels_(labels) {}

  Made operator()(const session::InstructionStep& step) const {
    return std::make_shared<PagesScreen>(step.pages, words_);
  }
  Made operator()(const session::QuestionStep& step) const {
    return std::make_shared<QuestionScreen>(*step.questionnaire, context_);
  }
  Made operator()(const session::PracticeStep& step) const {
    const bool again = step.round > 1;
    return note(again ? words_.practice_again_title : words_.practice_title,
                again ? words_.practice_again_text : words_.practice_text, "",
                words_.practice_start);
  }
  Made operator()(const session::ReadyStep& step) const {
    Progress progress;
    progress.done = step.trial - 1;
    progress.of = step.of;
    progress.text =
        with_numbers(step.practice ? words_.practice_of : words_.trial_of, {step.trial, step.of});
    return note(words_.ready_title, context_.mouse ? words_.ready_text_mouse : words_.ready_text,
                words_.ready_keys, words_.go_on, progress);
  }
  Made operator()(const session::AnswerStep& step) const {
    return std::make_shared<AnswerScreen>(step, context_, labels_);
  }
  Made operator()(const session::FeedbackStep& step) const {
    return std::make_shared<FeedbackScreen>(step, context_, labels_);
  }
  Made operator()(const session::BreakStep& step) const {
    Progress progress;
    progress.done = step.done;
    progress.of = step.of;
    const std::string done =
        step.of > 0 ? with_numbers(words_.break_done, {step.done, step.of}) : "";
    return note(words_.break_title, words_.break_text, done, words_.go_on, progress);
  }
  Made operator()(const session::PauseStep& /*step*/) const {
    return note(words_.pause_title, words_.pause_text, "", "");
  }
  Made operator()(const session::EndStep& /*step*/) const {
    return note(words_.end_title, words_.end_text, "", words_.finish);
  }

 private:
  [[nodiscard]] static Made note(const char* title, const char* body, const std::string& small,
                                 const char* button, const Progress& progress = Progress()) {
    NoteScreen::Content content;
    content.progress = progress;
    content.title = title;
    content.body = body;
    content.note = small;
    content.button = button;
    return std::make_shared<NoteScreen>(std::move(content));
  }

  const ScreenContext& context_;
  const Words& words_;
  const std::vector<std::string>& labels_;
};

bool same(const session::InstructionStep& a, const session::InstructionStep& b) {
  return a.pages == b.pages;
}
bool same(const session::QuestionStep& a, const session::QuestionStep& b) {
  return a.questionnaire == b.questionnaire;
}
bool same(const session::PracticeStep& a, const session::PracticeStep& b) {
  return a.round == b.round;
}
bool same(const session::ReadyStep& a, const session::ReadyStep& b) {
  return a.trial == b.trial && a.practice == b.practice;
}
bool same(const session::AnswerStep& a, const session::AnswerStep& b) {
  return a.trial == b.trial && a.practice == b.practice;
}
bool same(const session::FeedbackStep& a, const session::FeedbackStep& b) {
  return a.answered == b.answered && a.correct == b.correct;
}
bool same(const session::BreakStep& a, const session::BreakStep& b) {
  return a.done == b.done;
}
bool same(const session::PauseStep& /*a*/, const session::PauseStep& /*b*/) {
  return true;
}
bool same(const session::EndStep& /*a*/, const session::EndStep& /*b*/) {
  return true;
}

}  // namespace

std::shared_ptr<Screen> screen_for(const session::Step& step, const ScreenContext& context,
                                   const std::vector<std::string>& labels) {
  return std::visit(Maker(context, labels), step);
}

bool is_same_step(const session::Step& a, const session::Step& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&b](const auto& first) { return same(first, std::get<std::decay_t<decltype(first)>>(b)); },
      a);
}

}  // namespace touchtrial::app
