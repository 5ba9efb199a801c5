/// \file One screen of the participant's window: what it shows, and what it makes of keys and
/// clicks. Knows neither window nor threads; one thread at a time has it.
#pragma once

#include "app/participant/canvas.hpp"
#include "app/participant/input_event.hpp"
#include "app/participant/words.hpp"
#include "protocols/session/step.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// How large things are on the screen.
struct Glass {
  double mm_per_unit = 25.4 / 96.0;
  bool is_known = false;
};

/// What all screens of a session share; outlives them.
struct ScreenContext {
  const Words* words = nullptr;
  std::string language = "en";
  design::Sight sight = design::Sight::curtain;
  bool mouse = false;             ///< the device is a mouse
  PictureShelf* shelf = nullptr;  ///< of the pictures below
  const Glass* glass = nullptr;
};

class Screen {
 public:
  using Time = InputEvent::Time;

  virtual ~Screen() = default;

  /// Draws one picture of it, and remembers where things are.
  void draw(Canvas& canvas);
  /// Attention that `draw` is to show: give it to the canvas.
  [[nodiscard]] const Attention& attention() const noexcept { return attention_; }
  /// \return the reply, once: whatever comes after it is ignored
  [[nodiscard]] std::optional<session::StepReply> take(const InputEvent& event);
  /// Whether its picture changes by itself.
  [[nodiscard]] virtual bool is_alive() const noexcept { return false; }
  [[nodiscard]] bool is_done() const noexcept { return done_; }

 protected:
  virtual void paint(Canvas& canvas) = 0;
  /// A target was clicked, or chosen by keys.
  [[nodiscard]] virtual std::optional<session::StepReply> activate(int id, Time at) = 0;
  /// \return the target that Enter stands for where none has the focus; -1: none
  [[nodiscard]] virtual int default_target() const noexcept { return -1; }
  /// Keys that mean something else than elsewhere. \return whether it was one
  virtual bool takes_key(const InputEvent& /*event*/) { return false; }

  void focus(int id) noexcept { attention_.focus = id; }
  [[nodiscard]] bool has_target(int id) const noexcept;
  [[nodiscard]] const std::vector<Target>& targets() const noexcept { return targets_; }

 private:
  [[nodiscard]] std::optional<session::StepReply> take_key(const InputEvent& event);
  [[nodiscard]] std::optional<session::StepReply> take_pointer(const InputEvent& event);
  [[nodiscard]] int target_at(Vec2 position) const noexcept;
  void move_focus(Key key);

  Attention attention_;
  std::vector<Target> targets_;
  bool done_ = false;
};

/// \param labels  of the pictures, by position
[[nodiscard]] std::shared_ptr<Screen> screen_for(const session::Step& step,
                                                 const ScreenContext& context,
                                                 const std::vector<std::string>& labels);

/// Whether a step is the one that is shown already, asked for again.
[[nodiscard]] bool is_same_step(const session::Step& a, const session::Step& b);

/// Targets of every screen.
inline constexpr int kNextTarget = 100;
inline constexpr int kBackTarget = 101;

}  // namespace touchtrial::app
