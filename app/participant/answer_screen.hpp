/// \file The screens after exploring: the choice, how sure the participant is of it, and in
/// practice whether it was right.
#pragma once

#include "app/participant/screen.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Shows pictures of the originals in the participant's layout, or their names if answers are
/// spoken. A choice may be changed once; after that, only Next remains.
class AnswerScreen final : public Screen {
 public:
  AnswerScreen(const session::AnswerStep& step, const ScreenContext& context,
               std::vector<std::string> labels);

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override;
  bool takes_key(const InputEvent& event) override;

  void paint_pictures(Canvas& canvas, const Box& area);
  void paint_picture(Canvas& canvas, int position, const Box& picture);
  void paint_names(Canvas& canvas, const Box& area);
  void paint_confidence(Canvas& canvas);
  void choose(int position);
  [[nodiscard]] bool is_fixed() const noexcept { return first_.has_value(); }
  [[nodiscard]] int count() const noexcept { return static_cast<int>(labels_.size()); }
  [[nodiscard]] std::string hint() const;

  session::AnswerStep step_;
  ScreenContext context_;
  std::vector<std::string> labels_;
  int chosen_ = -1;
  std::optional<int> first_;
  std::optional<Time> answered_at_;  ///< set while the confidence is asked
  int confidence_ = 0;
};

/// What a practice answer was, and what it should have been.
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

}  // namespace touchtrial::app
