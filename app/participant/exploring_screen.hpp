/// \file The screen while a plane is on. Nothing on it depends on what is presented.
#pragma once

#include "app/participant/screen.hpp"
#include "core/plane_geometry.hpp"
#include "device/mouse/pointer_exchange.hpp"

#include <atomic>

namespace touchtrial::app {

/// What the practice's bars show. Written behind the servo, read by the drawing thread.
struct FeltNow {
  std::atomic<float> force_n{0.0F};
  std::atomic<float> speed_mm_s{0.0F};
};

/// Where the plane of the device "mouse" lies in the window.
struct PlaneOnScreen {
  Vec2 corner;
  double mm_per_unit = 1.0;
  double shown = 1.0;  ///< of its true size
};
[[nodiscard]] PlaneOnScreen place_plane(Vec2 window, Vec2 plane_mm, double mm_per_unit);

/// What a plane is explored with.
struct ExploringView {
  const FeltNow* bars = nullptr;               ///< in practice
  device::PointerExchange* pointer = nullptr;  ///< the mouse's plane and stylus
  const std::atomic<bool>* pressed = nullptr;  ///< the mouse's button, with `pointer`
  PlaneGeometry plane;
};

class ExploringScreen final : public Screen {
 public:
  ExploringScreen(const ExploringView& view, const ScreenContext& context)
      : view_(view), context_(context) {}

  [[nodiscard]] bool is_alive() const noexcept override {
    return view_.bars != nullptr || view_.pointer != nullptr;
  }

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int /*id*/, Time /*at*/) override {
    return std::nullopt;
  }
  void paint_plane(Canvas& canvas);
  void paint_bars(Canvas& canvas);

  ExploringView view_;
  ScreenContext context_;
};

}  // namespace touchtrial::app
