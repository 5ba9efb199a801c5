/// \file The participant's answer screens: choice, confidence, feedback in practice, and
///   questionnaire.
#pragma once

#include "app/windows/participant/screen.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Shows pictures of the originals in the participant's layout, their names if answers are spoken,
/// or large buttons with words if the step has a question. A choice may be changed once; after
/// that, only Next remains.
class AnswerScreen final : public Screen {
 public:
  AnswerScreen(const session::AnswerStep& step, const ScreenContext& context,
               std::vector<std::string> labels);

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override;
  bool handle_special_key(const InputEvent& event) override;

  void paint_pictures(Canvas& canvas, const Box& area);
  void paint_picture(Canvas& canvas, int position, const Box& picture);
  void paint_words(Canvas& canvas, const Box& area);
  /// Draws the number of a choice below it.
  void paint_number(Canvas& canvas, int position, const Box& badge) const;
  void paint_names(Canvas& canvas, const Box& area);
  void paint_confidence(Canvas& canvas);
  void choose(int position);
  [[nodiscard]] bool is_fixed() const noexcept { return first_choice_.has_value(); }
  [[nodiscard]] int count() const noexcept { return static_cast<int>(labels_.size()); }
  [[nodiscard]] std::string hint() const;
  [[nodiscard]] bool has_words() const noexcept {
    return std::get<study::ChoiceQuestion>(step_.question).has_words();
  }
  /// Key of the question's title; empty: the question which picture was felt.
  [[nodiscard]] const std::string& title() const noexcept {
    return std::get<study::ChoiceQuestion>(step_.question).title;
  }
  [[nodiscard]] std::string name_of(int position) const;

  session::AnswerStep step_;
  ScreenContext context_;
  std::vector<std::string> labels_;
  int choice_ = -1;
  std::optional<int> first_choice_;
  std::optional<Time> answered_at_;  ///< set while the confidence is asked for
  int confidence_ = 0;
};

/// Shows the participant's answer and the right one.
class FeedbackScreen final : public Screen {
 public:
  FeedbackScreen(const session::FeedbackStep& step, const ScreenContext& context,
                 std::vector<std::string> labels);

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }

  [[nodiscard]] std::string name_of(int position) const;
  void paint_pictures(Canvas& canvas, const Box& area, const std::vector<int>& positions);

  session::FeedbackStep step_;
  ScreenContext context_;
  std::vector<std::string> labels_;
};

/// A questionnaire, one question at a time.
class QuestionScreen final : public Screen {
 public:
  QuestionScreen(const session::QuestionStep& step, const ScreenContext& context);

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }
  bool handle_special_key(const InputEvent& event) override;

  void paint_options(Canvas& canvas, const Box& area);
  void paint_field(Canvas& canvas, const Box& area);
  void choose(int option);
  void insert(char32_t letter);
  bool edit(Key key);
  [[nodiscard]] const study::Question& question() const { return questionnaire_.questions[page_]; }
  [[nodiscard]] std::u32string& typed_text() { return typed_texts_[page_]; }
  [[nodiscard]] bool is_answered() const;
  /// Whether the question does not accept the typed text as a number.
  [[nodiscard]] bool is_invalid() const;
  [[nodiscard]] bool can_continue() const {
    return (is_answered() || !question().required) && !is_invalid();
  }
  [[nodiscard]] std::string range_text() const;
  [[nodiscard]] std::string translated(const study::Translated& text) const;
  [[nodiscard]] std::vector<std::string> answers() const;

  study::Questionnaire questionnaire_;  ///< a copy, because the screen may outlive the step
  ScreenContext context_;
  std::size_t page_ = 0;
  std::vector<int> choices_;                 ///< chosen option of each question; -1: none
  std::vector<std::u32string> typed_texts_;  ///< text of each question
  std::size_t caret_ = 0;
};

}  // namespace touchtrial::app
