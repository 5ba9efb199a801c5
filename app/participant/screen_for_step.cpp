#include "app/participant/answer_screen.hpp"
#include "app/participant/feedback_screen.hpp"
#include "app/participant/question_screen.hpp"
#include "app/participant/screen.hpp"
#include "app/participant/simple_screens.hpp"

#include <type_traits>
#include <utility>

namespace touchtrial {
namespace {

using Made = std::shared_ptr<Screen>;

/// A screen for each kind of step.
class Maker {
 public:
  Maker(const ScreenContext& context, const std::vector<std::string>& labels)
      : context_(context), words_(*context.words), labels_(labels) {}

  Made operator()(const InstructionStep& step) const {
    return std::make_shared<PagesScreen>(step.pages, words_);
  }
  Made operator()(const QuestionStep& step) const {
    return std::make_shared<QuestionScreen>(*step.questionnaire, context_);
  }
  Made operator()(const PracticeStep& step) const {
    const bool again = step.round > 1;
    return note(again ? words_.practice_again_title : words_.practice_title,
                again ? words_.practice_again_text : words_.practice_text, "",
                words_.practice_start);
  }
  Made operator()(const ReadyStep& step) const {
    Progress progress;
    progress.done = step.trial - 1;
    progress.of = step.of;
    progress.text =
        with_numbers(step.practice ? words_.practice_of : words_.trial_of, {step.trial, step.of});
    return note(words_.ready_title, context_.mouse ? words_.ready_text_mouse : words_.ready_text,
                words_.ready_keys, words_.go_on, progress);
  }
  Made operator()(const AnswerStep& step) const {
    return std::make_shared<AnswerScreen>(step, context_, labels_);
  }
  Made operator()(const FeedbackStep& step) const {
    return std::make_shared<FeedbackScreen>(step, context_, labels_);
  }
  Made operator()(const BreakStep& step) const {
    Progress progress;
    progress.done = step.done;
    progress.of = step.of;
    const std::string done =
        step.of > 0 ? with_numbers(words_.break_done, {step.done, step.of}) : "";
    return note(words_.break_title, words_.break_text, done, words_.go_on, progress);
  }
  Made operator()(const PauseStep& /*step*/) const {
    return note(words_.pause_title, words_.pause_text, "", "");
  }
  Made operator()(const EndStep& /*step*/) const {
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

bool same(const InstructionStep& a, const InstructionStep& b) {
  return a.pages == b.pages;
}
bool same(const QuestionStep& a, const QuestionStep& b) {
  return a.questionnaire == b.questionnaire;
}
bool same(const PracticeStep& a, const PracticeStep& b) {
  return a.round == b.round;
}
bool same(const ReadyStep& a, const ReadyStep& b) {
  return a.trial == b.trial && a.practice == b.practice;
}
bool same(const AnswerStep& a, const AnswerStep& b) {
  return a.trial == b.trial && a.practice == b.practice;
}
bool same(const FeedbackStep& a, const FeedbackStep& b) {
  return a.answered == b.answered && a.correct == b.correct;
}
bool same(const BreakStep& a, const BreakStep& b) {
  return a.done == b.done;
}
bool same(const PauseStep& /*a*/, const PauseStep& /*b*/) {
  return true;
}
bool same(const EndStep& /*a*/, const EndStep& /*b*/) {
  return true;
}

}  // namespace

std::shared_ptr<Screen> screen_for(const Step& step, const ScreenContext& context,
                                   const std::vector<std::string>& labels) {
  return std::visit(Maker(context, labels), step);
}

bool is_same_step(const Step& a, const Step& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&b](const auto& first) { return same(first, std::get<std::decay_t<decltype(first)>>(b)); },
      a);
}

}  // namespace touchtrial
