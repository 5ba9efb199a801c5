#include "app/windows/participant/card_screen.hpp"

#include "app/windows/participant/page_layout.hpp"
#include "core/units.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

// The size of bank cards. Source: ISO/IEC 7810, ID-1.
constexpr double kCardWidthMm = 85.60;
constexpr double kCardHeightMm = 53.98;
constexpr double kCardCornerMm = 3.18;
// A card's width at 40 and 400 window units per inch.
constexpr double kMinFrameWidth = 135.0;
constexpr double kMaxFrameWidth = 1348.0;
constexpr double kLargeStep = 10.0;  ///< step of the up and down arrows, window units

}  // namespace

CardScreen::CardScreen(double mm_per_unit)
    : width_(std::clamp(std::round(kCardWidthMm / mm_per_unit), kMinFrameWidth, kMaxFrameWidth)) {}

double CardScreen::mm_per_unit() const noexcept {
  return kCardWidthMm / width_;
}

void CardScreen::paint(Canvas& canvas) {
  const double unit = canvas.unit();
  const Box area = draw_heading(canvas, "Hold a bank card against the frame",
                                "Left and Right change the frame's size in small steps, Down and "
                                "Up in large steps. Press Enter "
                                "when frame and card match.");
  const double height = width_ * kCardHeightMm / kCardWidthMm;
  const Box card = {std::round(area.x + (area.width - width_) / 2.0),
                    std::round(area.y + (area.height - height) / 2.0), width_, height};
  const double corner = kCardCornerMm / mm_per_unit();
  canvas.fill(card, tone::kCard, corner);
  canvas.outline(card, tone::kText, std::max(1.0, std::round(unit)), corner);
  canvas.draw_label(card, Letters::small, tone::kQuiet,
                    fmt::format("{:.1f} pixels per inch", kMmPerInch / mm_per_unit()));
  draw_footer(canvas, {{kNextTarget, "They match"}});
}

bool CardScreen::handle_special_key(const InputEvent& event) {
  double step = 0.0;
  if (event.key == Key::left) step = -1.0;
  if (event.key == Key::right) step = 1.0;
  if (event.key == Key::down) step = -kLargeStep;
  if (event.key == Key::up) step = kLargeStep;
  width_ = std::clamp(width_ + step, kMinFrameWidth, kMaxFrameWidth);
  return step != 0.0;
}

}  // namespace touchtrial::app
