/// \file The drawing of the instructions: how to hold the pen, how to stroke, and how to press.
#include "app/windows/participant/page_layout.hpp"

#include <array>
#include <cmath>

namespace touchtrial::app {
namespace {

using Curve = std::array<Vec2, 4>;

// Places in the drawing, which is 300 wide; its y axis begins at kTopY.
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
    area(kPlate, tone::kEdge);
    std::array<Vec2, 4> inside = kPlate;
    const Vec2 centre = {150.0, 231.0};
    for (Vec2& corner : inside) corner = centre + 0.975 * (corner - centre);
    area(inside, tone::kGround);
    limb(kMiddleFinger, 20.0);
    curve(kPen, 17.0, tone::kText);
    curve(kPen, 12.0, tone::kCard);
    area(kTip, tone::kText);
    curve(kForearm, 62.0 + kRim, tone::kText);
    curve(kPalm, 58.0 + kRim, tone::kText);
    curve(kForearm, 62.0, tone::kAccentPale);
    curve(kPalm, 58.0, tone::kAccentPale);
    limb(kThumb, 21.0);
    limb(kIndexFinger, 21.0);
    curve(kInsideOfPalm, 50.0, tone::kAccentPale);
    arrow({170, 249}, {205, 249}, tone::kAccent);
    arrow({170, 249}, {45, 249}, tone::kAccent);
    arrow({92, 165}, {92, 208}, tone::kGood);
  }

 private:
  static constexpr double kRim = 6.0;

  [[nodiscard]] Vec2 placed(Vec2 point) const {
    return {box_.x + scale_ * point.x, box_.y + scale_ * (point.y - kTopY)};
  }
  void curve(const Curve& points, double thickness, std::uint32_t colour) {
    canvas_.curve({placed(points[0]), placed(points[1]), placed(points[2]), placed(points[3])},
                  scale_ * thickness, colour);
  }
  template <std::size_t count>
  void area(std::array<Vec2, count> corners, std::uint32_t colour) {
    for (Vec2& corner : corners) corner = placed(corner);
    canvas_.area(corners, colour);
  }
  void limb(const Curve& points, double thickness) {
    curve(points, thickness + kRim, tone::kText);
    curve(points, thickness, tone::kAccentPale);
  }
  void arrow(Vec2 from, Vec2 to, std::uint32_t colour) {
    const Vec2 way = to - from;
    const Vec2 ahead = (11.0 / std::hypot(way.x, way.y)) * way;
    const Vec2 aside = {-0.7 * ahead.y, 0.7 * ahead.x};
    curve({from, from + (1.0 / 3.0) * way, from + (2.0 / 3.0) * way, to}, 4.0, colour);
    area(std::array<Vec2, 3>{to + ahead, to + aside, to - aside}, colour);
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
