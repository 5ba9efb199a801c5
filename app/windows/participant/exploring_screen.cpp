#include "app/windows/participant/exploring_screen.hpp"

#include "app/windows/look.hpp"
#include "app/windows/participant/page_layout.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::app {
namespace {

// The ranges of the instructions, and the ends of the bars. Source: docs/running-sessions.md.
constexpr double kGoodForceN[] = {0.5, 0.8};
constexpr double kTooHardN = 2.0;
constexpr double kFullForceN = 2.5;
constexpr double kGoodSpeedMmS[] = {50.0, 150.0};
constexpr double kFullSpeedMmS = 250.0;

constexpr double kExploringMargin = 40.0;
constexpr double kBottomHeight = 92.0;  ///< height of a line of text, or of the bars in practice

/// A bar with its good range marked; all values are fractions of its length.
struct Bar {
  std::string name;
  double share = 0.0;
  double good_low = 0.0;
  double good_high = 0.0;
  bool is_too_much = false;
};

void paint_bar(Canvas& canvas, const Box& room, const Bar& bar) {
  const double unit = canvas.unit();
  const double name_width = 120.0 * unit;
  canvas.draw_label({room.x, room.y, name_width, room.height}, Letters::small, tone::kQuiet,
                    bar.name, Align::left);
  const Box track = {room.x + name_width, room.y + (room.height - 14.0 * unit) / 2.0,
                     room.width - name_width, 14.0 * unit};
  canvas.fill(track, tone::kTrack, 7.0 * unit);
  canvas.fill({track.x + bar.good_low * track.width, track.y - 5.0 * unit,
               (bar.good_high - bar.good_low) * track.width, track.height + 10.0 * unit},
              0x40000000U | (tone::kGood & 0xFFFFFFU), 4.0 * unit);
  const double share = std::clamp(bar.share, 0.0, 1.0);
  const bool is_good = share >= bar.good_low && share <= bar.good_high;
  const std::uint32_t colour =
      bar.is_too_much ? tone::kWarn : (is_good ? tone::kGood : tone::kAccent);
  if (share > 0.0) {
    canvas.fill({track.x, track.y, std::max(share * track.width, track.height), track.height},
                colour, 7.0 * unit);
  }
}

}  // namespace

PlaneOnScreen place_plane(Vec2 window, Vec2 plane_mm, double mm_per_unit) {
  const double unit = design_unit(window);
  const Vec2 room = {window.x - 2.0 * kExploringMargin * unit,
                     window.y - (2.0 * kExploringMargin + kBottomHeight) * unit};
  const double min_mm_per_unit =
      std::max(plane_mm.x / std::max(room.x, 1.0), plane_mm.y / std::max(room.y, 1.0));
  PlaneOnScreen plane_area;
  plane_area.mm_per_unit = std::max(mm_per_unit, min_mm_per_unit);
  const Vec2 drawn_size = (1.0 / plane_area.mm_per_unit) * plane_mm;
  plane_area.corner = {std::round((window.x - drawn_size.x) / 2.0),
                       std::round((window.y - kBottomHeight * unit - drawn_size.y) / 2.0)};
  return plane_area;
}

void ExploringScreen::paint(Canvas& canvas) {
  if (view_.pointer != nullptr) paint_plane(canvas);
  if (view_.interval) paint_interval(canvas);
  if (view_.bars != nullptr) paint_bars(canvas);
  if (view_.shows_touch_request == nullptr || !*view_.shows_touch_request) return;
  const double unit = canvas.unit();
  const double top = view_.pointer != nullptr ? 4.0 * unit : 0.45 * canvas.size().y;
  canvas.draw_label({0.0, top, canvas.size().x, 32.0 * unit}, Letters::strong, tone::kWarn,
                    context_.words->touch_first);
}

void ExploringScreen::paint_plane(Canvas& canvas) {
  const double unit = canvas.unit();
  const Vec2 plane_mm = {view_.plane.width_mm(), view_.plane.height_mm()};
  const PlaneOnScreen plane_area =
      place_plane(canvas.size(), plane_mm, context_.physical_scale->mm_per_unit);
  const Vec2 drawn_size = (1.0 / plane_area.mm_per_unit) * plane_mm;
  const Box plane = {plane_area.corner.x, plane_area.corner.y, drawn_size.x, drawn_size.y};
  canvas.fill(plane, 0xFFF7F6F5);
  canvas.outline(plane, 0xFFA09A94, 1.0);
  // In practice the bars are drawn below.
  const double bottom_distance = (view_.bars == nullptr ? 84.0 : 126.0) * unit;
  canvas.draw_label({0.0, canvas.size().y - bottom_distance, canvas.size().x, 30.0 * unit},
                    Letters::small, tone::kQuiet, text_below_plane());
  const device::StylusState stylus = view_.pointer->stylus();
  if (stylus.sequence == 0) return;
  draw_stylus(plane_area.corner + (1.0 / plane_area.mm_per_unit) * stylus.position_mm,
              view_.pressed->load(), static_cast<float>(unit));
}

const std::string& ExploringScreen::text_below_plane() const {
  const Words& words = *context_.words;
  if (!view_.interval) return words.exploring_mouse;
  if (must_lift()) return words.interval_text_mouse;
  return view_.interval->hand_off ? words.exploring_hand_off : words.exploring_interval_mouse;
}

/// Draws title and progress above the plane if one is drawn, otherwise in the middle with the
/// instruction.
void ExploringScreen::paint_interval(Canvas& canvas) {
  const Words& words = *context_.words;
  const double unit = canvas.unit();
  const double middle = canvas.size().x / 2.0;
  const std::string title = fill_numbers(
      words.interval_of, {{"interval", view_.interval->interval}, {"of", view_.interval->total}});
  if (view_.pointer != nullptr) {
    const double left = middle - 80.0 * unit;
    canvas.draw_label({left - 420.0 * unit, 5.0 * unit, 420.0 * unit, 30.0 * unit}, Letters::strong,
                      tone::kText, title, Align::right);
    paint_progress(canvas, {left + 24.0 * unit, 14.0 * unit, 300.0 * unit, 12.0 * unit});
    return;
  }
  const double width = 1000.0 * unit;
  const double top = 0.386 * canvas.size().y;
  canvas.draw_label({middle - width / 2.0, top, width, 56.0 * unit}, Letters::title, tone::kText,
                    title);
  const Box text_box{middle - width / 2.0, top + 58.0 * unit, width, 66.0 * unit};
  if (must_lift()) {
    canvas.draw_label(text_box, Letters::strong, tone::kWarn, words.interval_text);
  } else {
    canvas.draw_label(
        text_box, Letters::body, tone::kText,
        view_.interval->hand_off ? words.exploring_hand_off : words.exploring_interval);
  }
  paint_progress(canvas, {middle - 220.0 * unit, top + 146.0 * unit, 440.0 * unit, 14.0 * unit});
}

void ExploringScreen::paint_progress(Canvas& canvas, const Box& track) {
  const double rounding = track.height / 2.0;
  canvas.fill(track, tone::kTrack, rounding);
  const int steps = std::min(view_.explored_steps->load(), kExploredSteps);
  if (steps <= 0) return;
  const double share = static_cast<double>(steps) / kExploredSteps;
  canvas.fill({track.x, track.y, std::max(share * track.width, track.height), track.height},
              tone::kAccent, rounding);
}

void ExploringScreen::paint_bars(Canvas& canvas) {
  const Words& words = *context_.words;
  const double unit = canvas.unit();
  const double force_n = view_.bars->force_n;
  const double width = 560.0 * unit;
  const double x = (canvas.size().x - width) / 2.0;
  const double y = canvas.size().y - 92.0 * unit;
  const bool too_hard = force_n > kTooHardN;
  paint_bar(canvas, {x, y, width, 34.0 * unit},
            {words.force, force_n / kFullForceN, kGoodForceN[0] / kFullForceN,
             kGoodForceN[1] / kFullForceN, too_hard});
  paint_bar(canvas, {x, y + 38.0 * unit, width, 34.0 * unit},
            {words.speed, static_cast<double>(view_.bars->speed_mm_s) / kFullSpeedMmS,
             kGoodSpeedMmS[0] / kFullSpeedMmS, kGoodSpeedMmS[1] / kFullSpeedMmS, false});
  if (!too_hard) return;
  canvas.draw_label({x + width + 24.0 * unit, y, 300.0 * unit, 34.0 * unit}, Letters::strong,
                    tone::kWarn, words.too_hard, Align::left);
}

}  // namespace touchtrial::app
