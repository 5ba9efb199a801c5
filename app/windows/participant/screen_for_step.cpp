#include "app/windows/participant/answer_screen.hpp"
#include "app/windows/participant/page_layout.hpp"
#include "app/windows/participant/rating_screen.hpp"
#include "app/windows/participant/screen.hpp"
#include "study/languages.hpp"

#include <sstream>
#include <type_traits>
#include <utility>

namespace touchtrial::app {
namespace {

/// A card with at most one button.
class NoteScreen final : public Screen {
 public:
  struct Content {
    Progress progress;
    std::string title;
    std::string body;
    std::string note;
    std::string button;  ///< empty: no button; the session continues by itself
    bool space_continues = true;
  };
  explicit NoteScreen(Content content) : content_(std::move(content)) {}

 private:
  void paint(Canvas& canvas) override {
    draw_progress(canvas, content_.progress);
    draw_card(canvas, content_.title, content_.body, content_.note);
    if (!content_.button.empty()) draw_footer(canvas, {{kNextTarget, content_.button}});
  }
  [[nodiscard]] std::optional<session::StepReply> activate(int /*id*/, Time /*at*/) override {
    return session::StepReply{};
  }
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }
  bool handle_special_key(const InputEvent& event) override {
    return event.key == Key::space && !content_.space_continues;
  }

  Content content_;
};

/// Pages that can be turned in both directions; the button of the last page replies.
class PagesScreen final : public Screen {
 public:
  PagesScreen(const std::vector<std::string>& pages, const ScreenContext& context)
      : words_(*context.words), shelf_(context.shelf) {
    for (const std::string& page : pages) pages_.push_back(parse(page));
    if (pages_.empty()) pages_.emplace_back();
  }

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }

  struct Page {
    std::string title;
    std::string body;
    std::vector<std::string> pictures;
  };
  [[nodiscard]] static Page parse(const std::string& text);

  std::vector<Page> pages_;
  const Words& words_;
  PictureShelf* shelf_;
  std::size_t page_ = 0;
};

PagesScreen::Page PagesScreen::parse(const std::string& text) {
  Page page;
  std::istringstream lines(text);
  bool after_picture = false;
  for (std::string line; std::getline(lines, line);) {
    const auto picture = study::picture_in(line);
    if (!picture.empty()) page.pictures.emplace_back(picture);
    // An empty line after a picture is dropped.
    if (picture.empty() && !(after_picture && line.empty())) page.body += line + "\n";
    after_picture = !picture.empty();
  }
  page.body.erase(page.body.find_last_not_of('\n') + 1);
  page.body.erase(0, page.body.find_first_not_of('\n'));
  // A short first line is the page's heading.
  const std::size_t line = page.body.find('\n');
  constexpr std::size_t kMaxHeadingLength = 60;
  if (line != page.body.npos && line <= kMaxHeadingLength) {
    page.title = page.body.substr(0, line);
    page.body.erase(0, page.body.find_first_not_of('\n', line));
  }
  return page;
}

void PagesScreen::paint(Canvas& canvas) {
  const int count = static_cast<int>(pages_.size());
  const int page = static_cast<int>(page_) + 1;
  if (count > 1)
    draw_progress(canvas,
                  {page, count, fill_numbers(words_.page_of, {{"page", page}, {"of", count}})});
  const Page& current_page = pages_[page_];
  draw_card(canvas, current_page.title, current_page.body, "", Align::left,
            {current_page.pictures, shelf_});
  std::vector<FooterButton> buttons;
  if (page_ > 0) buttons.push_back({kBackTarget, words_.back, false});
  buttons.push_back({kNextTarget, words_.next});
  draw_footer(canvas, buttons);
}

std::optional<session::StepReply> PagesScreen::activate(int id, Time /*at*/) {
  focus(-1);
  if (id == kBackTarget) {
    if (page_ > 0) --page_;
    return std::nullopt;
  }
  if (++page_ < pages_.size()) return std::nullopt;
  page_ = pages_.size() - 1;
  return session::StepReply{};
}

using ScreenPointer = std::shared_ptr<Screen>;

/// Makes the screen for each kind of step.
class ScreenMaker {
 public:
  ScreenMaker(const ScreenContext& context, const std::vector<std::string>& labels)
      : context_(context), words_(*context.words), labels_(labels) {}

  ScreenPointer operator()(const session::InstructionStep& step) const {
    return std::make_shared<PagesScreen>(step.pages, context_);
  }
  ScreenPointer operator()(const session::QuestionStep& step) const {
    return std::make_shared<QuestionScreen>(step, context_);
  }
  ScreenPointer operator()(const session::PracticeStep& step) const {
    const bool is_repeated = step.round > 1;
    return note_screen(is_repeated ? words_.practice_again_title : words_.practice_title,
                       is_repeated ? words_.practice_again_text : practice_text(), "",
                       words_.practice_start);
  }
  ScreenPointer operator()(const session::ReadyStep& step) const {
    return note_screen(words_.ready_title, ready_text(step), words_.ready_keys, words_.go_on,
                       progress_of(words_, step.trial, step.total, step.practice));
  }
  ScreenPointer operator()(const session::IntervalStep& step) const {
    const std::string& pen = context_.mouse ? words_.interval_text_mouse : words_.interval_text;
    return note_screen(
        fill_numbers(words_.interval_of, {{"interval", step.interval}, {"of", step.total}}),
        step.hand_off ? words_.interval_text_hand_off : pen, "", "");
  }
  ScreenPointer operator()(const session::AnswerStep& step) const {
    if (std::holds_alternative<study::RatingQuestion>(step.question)) {
      return std::make_shared<RatingScreen>(step, context_);
    }
    return std::make_shared<AnswerScreen>(step, context_, labels_);
  }
  ScreenPointer operator()(const session::FeedbackStep& step) const {
    return std::make_shared<FeedbackScreen>(step, context_, labels_);
  }
  ScreenPointer operator()(const session::BreakStep& step) const {
    const std::string done =
        step.total > 0 ? fill_numbers(words_.break_done, {{"done", step.done}, {"of", step.total}})
                       : "";
    return note_screen(words_.break_title, words_.break_text, done, words_.go_on,
                       {step.done, step.total, ""});
  }
  ScreenPointer operator()(const session::NoticeStep& step) const {
    using What = session::NoticeStep::What;
    if (step.what == What::practice_over) {
      return note_screen(words_.practice_over_title, practice_over_text(), "", words_.go_on);
    }
    if (step.what == What::time_is_up) {
      return note_screen(words_.no_response_title, words_.no_response_text, "", words_.go_on);
    }
    if (step.what == What::not_explored) {
      return note_screen(words_.not_explored_title, words_.not_explored_text, "", words_.go_on);
    }
    if (step.what == What::hand_off) {
      return note_screen(words_.hand_off_title, words_.hand_off_text, "", words_.go_on);
    }
    // A person who stops the force may press the space bar more than once.
    return std::make_shared<NoteScreen>(
        NoteScreen::Content{{},
                            words_.stopped_title,
                            step.can_resume ? words_.stopped_text_alone : words_.stopped_text,
                            "",
                            step.can_resume ? words_.go_on : "",
                            false});
  }
  ScreenPointer operator()(const session::PauseStep& /*step*/) const {
    return note_screen(words_.pause_title, words_.pause_text, "", "");
  }
  ScreenPointer operator()(const session::EndStep& /*step*/) const {
    return note_screen(words_.end_title, words_.end_text, "", words_.finish);
  }

 private:
  [[nodiscard]] const std::string& practice_text() const {
    if (context_.has_ratings()) return words_.practice_text_rating;
    if (context_.has_clock()) return words_.practice_text_intervals;
    const bool is_spoken = context_.sight == study::Sight::blindfold;
    return is_spoken ? words_.practice_text_blindfold : words_.practice_text;
  }
  [[nodiscard]] const std::string& practice_over_text() const {
    if (context_.has_ratings()) return words_.practice_over_text_rating;
    const bool has_feedback = context_.trial_question.feedback;
    return has_feedback ? words_.practice_over_text_feedback : words_.practice_over_text;
  }
  [[nodiscard]] const std::string& ready_text(const session::ReadyStep& step) const {
    if (step.hand_off) return words_.ready_text_hand_off;
    if (context_.has_clock()) {
      return context_.mouse ? words_.ready_text_intervals_mouse : words_.ready_text_intervals;
    }
    return context_.mouse ? words_.ready_text_mouse : words_.ready_text;
  }
  [[nodiscard]] static ScreenPointer note_screen(const std::string& title, const std::string& body,
                                                 const std::string& note_text,
                                                 const std::string& button,
                                                 const Progress& progress = Progress()) {
    return std::make_shared<NoteScreen>(
        NoteScreen::Content{progress, title, body, note_text, button});
  }

  const ScreenContext& context_;
  const Words& words_;
  const std::vector<std::string>& labels_;
};

bool is_same(const session::InstructionStep& a, const session::InstructionStep& b) {
  return a.pages == b.pages;
}
bool is_same(const session::QuestionStep& a, const session::QuestionStep& b) {
  return a.questionnaire == b.questionnaire;
}
bool is_same(const session::PracticeStep& a, const session::PracticeStep& b) {
  return a.round == b.round;
}
bool is_same(const session::ReadyStep& a, const session::ReadyStep& b) {
  return a.trial == b.trial && a.practice == b.practice;
}
bool is_same(const session::IntervalStep& a, const session::IntervalStep& b) {
  return a.trial == b.trial && a.practice == b.practice && a.interval == b.interval;
}
bool is_same(const session::AnswerStep& a, const session::AnswerStep& b) {
  return a.trial == b.trial && a.practice == b.practice;
}
bool is_same(const session::FeedbackStep& a, const session::FeedbackStep& b) {
  return a.answered == b.answered && a.correct == b.correct;
}
bool is_same(const session::BreakStep& a, const session::BreakStep& b) {
  return a.done == b.done;
}
bool is_same(const session::NoticeStep& a, const session::NoticeStep& b) {
  return a.what == b.what && a.presentations == b.presentations && a.can_resume == b.can_resume;
}
bool is_same(const session::PauseStep& /*a*/, const session::PauseStep& /*b*/) {
  return true;
}
bool is_same(const session::EndStep& /*a*/, const session::EndStep& /*b*/) {
  return true;
}

}  // namespace

std::shared_ptr<Screen> screen_for(const session::Step& step, const ScreenContext& context,
                                   const std::vector<std::string>& labels) {
  return std::visit(ScreenMaker(context, labels), step);
}

bool is_same_step(const session::Step& a, const session::Step& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&b](const auto& first) {
        return is_same(first, std::get<std::decay_t<decltype(first)>>(b));
      },
      a);
}

}  // namespace touchtrial::app
