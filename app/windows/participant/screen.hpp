/// \file One screen of the participant's window: drawing, and handling of keys and clicks. It needs
///   no window; one thread at a time uses it.
#pragma once

#include "app/windows/participant/canvas.hpp"
#include "app/windows/participant/input_event.hpp"
#include "app/windows/participant/words.hpp"
#include "core/units.hpp"
#include "protocols/session/participant.hpp"
#include "study/ask.hpp"

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace touchtrial::app {

/// The physical scale of the screen.
struct PhysicalScale {
  double mm_per_unit = kMmPerInch / 96.0;
  bool is_known = false;  ///< false: the scale is a guess
};

/// The shared data of all screens of a session. The objects it points to must outlive the screens.
struct ScreenContext {
  const Words* words = nullptr;
  std::string language = "en";
  study::Sight sight = study::Sight::curtain;
  bool mouse = false;  ///< the device is a mouse
  PictureShelf* shelf = nullptr;
  const PhysicalScale* physical_scale = nullptr;
  study::TrialQuestion trial_question{};  ///< question of the study's trials

  /// Whether planes have a clock (study::TimedContact).
  [[nodiscard]] bool has_clock() const noexcept {
    return std::holds_alternative<study::TimedContact>(trial_question.exploring);
  }
  /// Whether trials ask for ratings.
  [[nodiscard]] bool has_ratings() const noexcept {
    return std::holds_alternative<study::RatingQuestion>(trial_question.question);
  }
};

class Screen {
 public:
  using Time = InputEvent::Time;

  virtual ~Screen() = default;

  /// Draws the screen and stores the boxes of its targets.
  void draw(Canvas& canvas);
  /// The focused, hovered and held targets, for the canvas of `draw`.
  [[nodiscard]] const Attention& attention() const noexcept { return attention_; }
  /// Handles an event. Events after the reply are ignored.
  /// \return the reply, once
  [[nodiscard]] std::optional<session::StepReply> handle(const InputEvent& event);
  /// Whether the screen changes without events.
  [[nodiscard]] virtual bool is_animated() const noexcept { return false; }
  [[nodiscard]] bool is_done() const noexcept { return is_done_; }

 protected:
  virtual void paint(Canvas& canvas) = 0;
  /// Called when a target is clicked or chosen by keys.
  [[nodiscard]] virtual std::optional<session::StepReply> activate(int id, Time at) = 0;
  /// \return the target that Enter activates if no target has the focus; -1: none
  [[nodiscard]] virtual int default_target() const noexcept { return -1; }
  /// Called when the mouse presses a target, moves while holding it, and releases it.
  virtual void drag(int /*id*/, Vec2 /*to*/) {}
  /// Handles keys that have a special meaning on this screen.
  /// \return whether the event was such a key
  virtual bool handle_special_key(const InputEvent& /*event*/) { return false; }

  void focus(int id) noexcept { attention_.focus = id; }
  [[nodiscard]] bool has_target(int id) const noexcept;

 private:
  [[nodiscard]] std::optional<session::StepReply> handle_key(const InputEvent& event);
  [[nodiscard]] std::optional<session::StepReply> handle_pointer(const InputEvent& event);
  [[nodiscard]] int target_at(Vec2 position) const noexcept;
  void move_focus(Key key);

  Attention attention_;
  std::vector<Target> targets_;
  bool is_done_ = false;
};

/// Makes the screen of a step.
/// \param labels  labels of the pictures, by position
[[nodiscard]] std::shared_ptr<Screen> screen_for(const session::Step& step,
                                                 const ScreenContext& context,
                                                 const std::vector<std::string>& labels);

/// Whether two steps share one screen.
[[nodiscard]] bool is_same_step(const session::Step& a, const session::Step& b);

/// Targets shared by screens.
inline constexpr int kNextTarget = 100;
inline constexpr int kBackTarget = 101;
inline constexpr int kFeelAgainTarget = 102;

}  // namespace touchtrial::app
