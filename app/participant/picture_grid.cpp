#include "app/participant/picture_grid.hpp"

#include "app/participant/page_layout.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::app {
namespace {

constexpr double kBarMm = 10.0;

Vec2 largest_of(const std::vector<Vec2>& sizes) {
  Vec2 largest{1.0, 1.0};
  for (const Vec2 size : sizes) {
    largest = {std::max(largest.x, size.x), std::max(largest.y, size.y)};
  }
  return largest;
}

}  // namespace

PictureGrid lay_out_pictures(const std::vector<Vec2>& sizes, const Box& area, double gap,
                             double below) {
  PictureGrid grid;
  const int count = static_cast<int>(sizes.size());
  if (count == 0) return grid;
  const Vec2 cell = largest_of(sizes);
  grid.shown = 0.0;
  int best_rows = 1;
  for (int rows = 1; rows <= count; ++rows) {
    const int columns = (count + rows - 1) / rows;
    const double wide = (area.width - gap * (columns - 1)) / columns / cell.x;
    const double high = ((area.height - gap * (rows - 1)) / rows - below) / cell.y;
    const double shown = std::min({1.0, wide, high});
    if (shown > grid.shown + 1e-9) {
      grid.shown = shown;
      best_rows = rows;
    }
  }
  grid.shown = std::max(grid.shown, 0.01);
  const int columns = (count + best_rows - 1) / best_rows;
  const Vec2 each = grid.shown * cell;
  const double row_height = each.y + below;
  const double top = area.y + (area.height - best_rows * row_height - (best_rows - 1) * gap) / 2.0;
  for (int i = 0; i < count; ++i) {
    const int row = i / columns;
    const int in_row = std::min(columns, count - row * columns);
    const double left = area.x + (area.width - in_row * each.x - (in_row - 1) * gap) / 2.0;
    const Vec2 size = grid.shown * sizes[static_cast<std::size_t>(i)];
    grid.pictures.push_back({left + (i % columns) * (each.x + gap) + (each.x - size.x) / 2.0,
                             top + row * (row_height + gap) + (each.y - size.y) / 2.0, size.x,
                             size.y});
  }
  return grid;
}

void draw_scale_bar(Canvas& canvas, const Box& room, const ScreenContext& context, double shown) {
  const Words& words = *context.words;
  const double unit = canvas.unit();
  const double length = shown * kBarMm / context.glass->mm_per_unit;
  std::string text = words.scale_true;
  if (!context.glass->is_known) text = words.scale_unknown;
  if (shown < 0.995) {
    text = with_numbers(words.scale_shrunk, {static_cast<int>(std::lround(100.0 * shown))});
  }
  text = "10 mm     " + text;
  const double gap = 12.0 * unit;
  const double letters =
      std::min(canvas.width_of(Letters::small, text) + unit, room.width - length - gap);
  const double x = std::round(room.x + (room.width - length - gap - letters) / 2.0);
  const double y = std::round(room.y + room.height / 2.0);
  const double thick = std::max(1.0, std::round(2.0 * unit));
  const double tick = std::round(6.0 * unit);
  canvas.fill({x, y - thick / 2.0, length, thick}, tone::kText);
  canvas.fill({x, y - tick, thick, 2.0 * tick}, tone::kText);
  canvas.fill({x + length - thick, y - tick, thick, 2.0 * tick}, tone::kText);
  canvas.label({x + length + gap, room.y, letters, room.height}, Letters::small, tone::kQuiet, text,
               Align::left);
}

}  // namespace touchtrial::app
