/// \file The drawing of the instructions: how to hold the pen, how to stroke, and how to press.
#include "app/windows/participant/page_layout.hpp"

#include <array>
#include <cmath>

namespace touchtrial::app {
namespace {

using Curve = std::array<Vec2, 4>;

// Coordinates in the drawing, which is 300 wide; its y axis starts at kTopY.
constexpr double kTopY = 45.0;
constexpr double kDrawingWidth = 300.0;
constexpr double kDrawingHeight = 245.0;
constexpr Curve kMiddleFinger = {{{238, 196}, {215, 214}, {190, 216}, {166, 208}}};
constexpr Curve kPen = {{{138, 226}, {160, 190}, {190, 140}, {236, 62}}};
constexpr Curve kForearm = {{{330, 262}, {300, 240}, {275, 205}, {252, 182}}};
constexpr Curve kPalm = {{{252, 182}, {246, 178}, {240, 172}, {236, 166}}};
constexpr Curve kThumb = {{{252, 190}, {226, 202}, {198, 204}, {168, 196}}};
constexpr Curve kIndexFinger = {{{252, 166}, {226, 138}, {194, 148}, {163, 186}}};
constexpr Curve kInsideOfPalm = {{{262, 190}, {256, 184}, {252, 180}, {246, 174}}};
constexpr std::array<Vec2, 4> kPlate = {{{8, 262}, {86, 200}, {292, 200}, {214, 262}}};
constexpr std::array<Vec2, 3> kTip = {{{124, 248}, {131, 222}, {145, 230}}};

/// Draws in the coordinates of the drawing.
class HandDrawing {
 public:
  HandDrawing(Canvas& canvas, const Box& box)
      : canvas_(canvas), box_(box), scale_(box.width / kDrawingWidth) {}

  void draw() {
    draw_area(kPlate, tone::kEdge);
    std::array<Vec2, 4> inner_plate = kPlate;
    const Vec2 centre = {150.0, 231.0};
    for (Vec2& corner : inner_plate) corner = centre + 0.975 * (corner - centre);
    draw_area(inner_plate, tone::kGround);
    draw_limb(kMiddleFinger, 20.0);
    draw_curve(kPen, 17.0, tone::kText);
    draw_curve(kPen, 12.0, tone::kCard);
    draw_area(kTip, tone::kText);
    draw_curve(kForearm, 62.0 + kRim, tone::kText);
    draw_curve(kPalm, 58.0 + kRim, tone::kText);
    draw_curve(kForearm, 62.0, tone::kAccentPale);
    draw_curve(kPalm, 58.0, tone::kAccentPale);
    draw_limb(kThumb, 21.0);
    draw_limb(kIndexFinger, 21.0);
    draw_curve(kInsideOfPalm, 50.0, tone::kAccentPale);
    draw_arrow({170, 249}, {205, 249}, tone::kAccent);
    draw_arrow({170, 249}, {45, 249}, tone::kAccent);
    draw_arrow({92, 165}, {92, 208}, tone::kGood);
  }

 private:
  static constexpr double kRim = 6.0;

  [[nodiscard]] Vec2 to_canvas(Vec2 point) const {
    return {box_.x + scale_ * point.x, box_.y + scale_ * (point.y - kTopY)};
  }
  void draw_curve(const Curve& points, double thickness, std::uint32_t colour) {
    canvas_.draw_curve(
        {to_canvas(points[0]), to_canvas(points[1]), to_canvas(points[2]), to_canvas(points[3])},
        scale_ * thickness, colour);
  }
  template <std::size_t count>
  void draw_area(std::array<Vec2, count> corners, std::uint32_t colour) {
    for (Vec2& corner : corners) corner = to_canvas(corner);
    canvas_.fill_area(corners, colour);
  }
  void draw_limb(const Curve& points, double thickness) {
    draw_curve(points, thickness + kRim, tone::kText);
    draw_curve(points, thickness, tone::kAccentPale);
  }
  void draw_arrow(Vec2 start, Vec2 end, std::uint32_t colour) {
    const Vec2 shaft = end - start;
    const Vec2 forward = (11.0 / std::hypot(shaft.x, shaft.y)) * shaft;
    const Vec2 sideways = {-0.7 * forward.y, 0.7 * forward.x};
    draw_curve({start, start + (1.0 / 3.0) * shaft, start + (2.0 / 3.0) * shaft, end}, 4.0, colour);
    draw_area(std::array<Vec2, 3>{end + forward, end + sideways, end - sideways}, colour);
  }

  Canvas& canvas_;
  Box box_;
  double scale_;
};

}  // namespace

Vec2 hand_drawing_size() noexcept {
  return {kDrawingWidth, kDrawingHeight};
}

void draw_hand(Canvas& canvas, const Box& box) {
  canvas.clip_to(box);
  HandDrawing(canvas, box).draw();
  canvas.end_clip();
}

}  // namespace touchtrial::app
