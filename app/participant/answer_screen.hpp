/// \file The choice after exploring, and how sure the participant is of it.
#pragma once

#include "app/participant/picture_grid.hpp"
#include "app/participant/screen.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Pictures of the originals in the participant's own layout, or their names where answers are
/// spoken. A choice may be changed once; then only Next is left.
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
  std::optional<Time> answered_at_;  ///< confidence is being asked
  int confidence_ = 0;
};

}  // namespace touchtrial::app
