/// \file The screen on which the participant rates a texture.
#pragma once

#include "app/windows/participant/screen.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace touchtrial::app {

/// Shows a picture and scales, which are lines or rows of numbers. There is no initial mark, so
/// that no rating is suggested. All ratings may be changed until Next, which requires all of them.
class RatingScreen final : public Screen {
 public:
  /// \pre the step asks for ratings
  RatingScreen(const session::AnswerStep& step, const ScreenContext& context);

 private:
  /// The positions of picture and scales.
  struct Arrangement {
    Box picture;
    Box scale_bar;
    double scale = 1.0;  ///< scale of the picture; 1 is true size
    Box rows;            ///< area of the scales, one below the other
  };

  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override;
  bool handle_special_key(const InputEvent& event) override;
  void drag(int id, Vec2 pointer) override;

  [[nodiscard]] Arrangement arrangement(const Box& room, double unit) const;
  void paint_scale(Canvas& canvas, std::size_t index, const Box& row);
  void paint_line(Canvas& canvas, std::size_t index, const Box& room);
  void paint_points(Canvas& canvas, std::size_t index, const Box& room);
  [[nodiscard]] const std::string& hint() const;

  /// Moves the marker of the scale with the keyboard focus.
  /// \param steps  positive: to the right
  void move_marker(int steps);
  void choose_number(int number);
  /// Moves the keyboard focus to the next or the previous scale or button.
  void move_focus_by(int step, bool wraps);
  /// After Enter, moves the keyboard focus to the next scale without a rating.
  /// \return whether it moved: the current scale has a rating and another has none
  bool move_to_unrated();
  [[nodiscard]] bool is_complete() const noexcept;

  session::AnswerStep step_;
  ScreenContext context_;
  std::vector<study::Scale> scales_;
  std::vector<std::optional<double>> ratings_;  ///< rating of each scale
  std::vector<Box> lines_;                      ///< position of each line in the last frame
  std::size_t current_ = 0;  ///< the scale with the keyboard focus, if no target has it
};

}  // namespace touchtrial::app
