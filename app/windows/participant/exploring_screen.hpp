/// \file The screen while a plane is on. Nothing on it depends on the stimulus.
#pragma once

#include "app/windows/participant/screen.hpp"
#include "core/plane_geometry.hpp"
#include "device/drivers/mouse/pointer_exchange.hpp"

#include <atomic>
#include <optional>
#include <string>

namespace touchtrial::app {

/// Force and speed for the practice bars. Written by the servo's listener, read by the drawing
/// thread.
struct HandReadings {
  std::atomic<float> force_n{0.0F};
  std::atomic<float> speed_mm_s{0.0F};
};

/// The area of the mouse device's plane in the window.
struct PlaneOnScreen {
  Vec2 corner;
  double mm_per_unit = 1.0;
};
[[nodiscard]] PlaneOnScreen place_plane(Vec2 window, Vec2 plane_mm, double mm_per_unit);

/// The bar of an interval grows in this number of steps, so that the screen is redrawn rarely.
inline constexpr int kExploredSteps = 40;

/// The data of the exploring screen.
struct ExploringView {
  const HandReadings* bars = nullptr;  ///< readings to show in practice; null: no bars
  device::PointerExchange* pointer =
      nullptr;  ///< the mouse device's exchange; null: no plane or stylus
  const std::atomic<bool>* pressed = nullptr;  ///< the mouse button; set if `pointer` is
  const std::atomic<bool>* shows_touch_request =
      nullptr;  ///< asks the participant to feel before answering
  PlaneGeometry plane;
  std::optional<session::IntervalStep> interval{};  ///< the plane is one of several
  /// Progress of the interval, from 0 to kExploredSteps; set if `interval` is.
  const std::atomic<int>* explored_steps = nullptr;
  const std::atomic<bool>* has_lifted =
      nullptr;  ///< whether the hand was lifted since the announcement; set if `interval` is
};

class ExploringScreen final : public Screen {
 public:
  ExploringScreen(const ExploringView& view, const ScreenContext& context)
      : view_(view), context_(context) {}

  [[nodiscard]] bool is_animated() const noexcept override {
    return view_.bars != nullptr || view_.pointer != nullptr;
  }

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int /*id*/, Time /*at*/) override {
    return std::nullopt;
  }
  void paint_plane(Canvas& canvas);
  void paint_bars(Canvas& canvas);
  void paint_interval(Canvas& canvas);
  [[nodiscard]] bool must_lift() const noexcept {
    return view_.interval && !view_.interval->hand_off && !view_.has_lifted->load();
  }
  void paint_progress(Canvas& canvas, const Box& track);
  [[nodiscard]] const std::string& text_below_plane() const;

  ExploringView view_;
  ScreenContext context_;
};

}  // namespace touchtrial::app
