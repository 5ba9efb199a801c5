#include "app/windows/participant/page_layout.hpp"

#include "study/languages.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::app {
namespace {

constexpr double kPageMargin = 56.0;
constexpr double kTop = 68.0;
constexpr double kFooter = 124.0;
constexpr double kButtonWidth = 220.0;  ///< minimum width of a button
constexpr double kButtonHeight = 64.0;
constexpr double kCardWidth = 900.0;
constexpr double kMinTextScale = 0.4;

constexpr double kBarMm = 10.0;
/// The maximum gap between pictures if space is tight, as a fraction of a picture's side.
constexpr double kGapShare = 0.25;

Vec2 max_size(const std::vector<Vec2>& sizes) {
  Vec2 largest{1.0, 1.0};
  for (const Vec2 size : sizes) {
    largest = {std::max(largest.x, size.x), std::max(largest.y, size.y)};
  }
  return largest;
}

/// The area between progress and buttons.
Box content_area(const Canvas& canvas) {
  const double unit = canvas.unit();
  return {kPageMargin * unit, kTop * unit, canvas.size().x - 2.0 * kPageMargin * unit,
          canvas.size().y - (kTop + kFooter) * unit};
}

}  // namespace

Progress progress_of(const Words& words, int trial, int total, bool practice) {
  return {trial - 1, total,
          fill_numbers(practice ? words.practice_of : words.trial_of,
                       {{"trial", trial}, {"of", total}})};
}

void draw_progress(Canvas& canvas, const Progress& progress) {
  if (progress.total <= 0) return;
  const double unit = canvas.unit();
  const double width = canvas.size().x;
  canvas.fill({0.0, 0.0, width, 6.0 * unit}, tone::kTrack);
  const double share = std::clamp(static_cast<double>(progress.done) / progress.total, 0.0, 1.0);
  canvas.fill({0.0, 0.0, width * share, 6.0 * unit}, tone::kAccent);
  canvas.draw_text({kPageMargin * unit, 22.0 * unit, width - 2.0 * kPageMargin * unit, 44.0 * unit},
                   Letters::small, tone::kQuiet, progress.text, Align::right);
}

std::string page_picture(const std::string& name) {
  return "![](" + name + ")";
}

namespace {

/// Width and height of a picture, in any unit.
Vec2 shape_of(const std::string& name, const CardPictures& pictures) {
  if (name == study::kHandDrawing || pictures.shelf == nullptr) return hand_drawing_size();
  return pictures.shelf->size_mm(page_picture(name));
}

/// Draws pictures one below the other, as large as the room allows.
void draw_pictures(Canvas& canvas, const CardPictures& pictures, const Box& room) {
  const auto count = static_cast<double>(pictures.names.size());
  const double gap = 16.0 * canvas.unit();
  const double max_height = (room.height - gap * (count - 1.0)) / count;
  std::vector<Vec2> sizes;
  double total = gap * (count - 1.0);
  for (const std::string& name : pictures.names) {
    const Vec2 shape = shape_of(name, pictures);
    sizes.push_back(std::min(room.width / shape.x, max_height / shape.y) * shape);
    total += sizes.back().y;
  }
  double y = room.y + (room.height - total) / 2.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Box box = {room.x + (room.width - sizes[i].x) / 2.0, y, sizes[i].x, sizes[i].y};
    if (pictures.names[i] == study::kHandDrawing) {
      draw_hand(canvas, box);
    } else if (pictures.shelf != nullptr) {
      canvas.draw_picture(*pictures.shelf, page_picture(pictures.names[i]), box);
    }
    y += sizes[i].y + gap;
  }
}

}  // namespace

void draw_card(Canvas& canvas, const std::string& title, const std::string& body,
               const std::string& note, Align align, const CardPictures& pictures) {
  const double unit = canvas.unit();
  const Box area = content_area(canvas);
  const bool has_pictures = !pictures.names.empty();
  const double column = has_pictures ? 300.0 * unit : 0.0;
  const double width = std::min(area.width, kCardWidth * unit + column);
  const double padding = 52.0 * unit;
  const double gap = 22.0 * unit;
  const double room = width - 2.0 * padding - (has_pictures ? column + gap : 0.0);
  const auto height_at = [&](double shrink) {
    double height = 2.0 * padding + canvas.measure(Letters::title, title, room, shrink);
    if (!body.empty()) height += gap + canvas.measure(Letters::rich, body, room, shrink);
    if (!note.empty()) height += 1.4 * gap + canvas.measure(Letters::small, note, room, shrink);
    return height;
  };
  double shrink = 1.0;
  while (height_at(shrink) > area.height && shrink > kMinTextScale) shrink *= 0.96;
  const double min_height = has_pictures ? std::min(area.height, column + 2.0 * padding) : 0.0;
  const double height = std::max(height_at(shrink), min_height);
  const Box card = {std::round(area.x + (area.width - width) / 2.0),
                    std::round(area.y + (area.height - height) / 2.0), width, height};
  canvas.fill(card, tone::kCard, 20.0 * unit);
  canvas.outline(card, tone::kEdge, unit, 20.0 * unit);
  if (has_pictures) {
    draw_pictures(
        canvas, pictures,
        {card.right() - padding - column, card.y + padding, column, height - 2.0 * padding});
  }
  const double offset = (height - height_at(shrink)) / 2.0;
  Box line = {card.x + padding, card.y + padding + offset, room, 0.0};
  const auto draw_lines = [&](Letters letters, std::uint32_t colour, const std::string& text) {
    line.height = card.bottom() - padding - line.y;
    line.y += canvas.draw_text(line, letters, colour, text, align, shrink);
  };
  if (!title.empty()) draw_lines(Letters::title, tone::kText, title);
  if (!body.empty()) {
    if (!title.empty()) line.y += gap;
    draw_lines(Letters::rich, tone::kText, body);
  }
  if (!note.empty()) {
    line.y += 1.4 * gap;
    draw_lines(Letters::small, tone::kQuiet, note);
  }
}

void draw_footer(Canvas& canvas, const std::vector<FooterButton>& buttons) {
  const double unit = canvas.unit();
  const double gap = 24.0 * unit;
  std::vector<double> widths;
  double width_before_next = 0.0;
  double next_width = kButtonWidth * unit;  // also if there is no such button
  for (const FooterButton& button : buttons) {
    const double letters =
        canvas.width_of(button.primary ? Letters::strong : Letters::body, button.label);
    widths.push_back(std::max(kButtonWidth * unit, letters + 72.0 * unit));
    if (button.id == kNextTarget) {
      next_width = widths.back();
    } else {
      width_before_next += widths.back() + gap;
    }
  }
  double x = std::round((canvas.size().x - next_width) / 2.0 - width_before_next);
  const double y = std::round(canvas.size().y - (kFooter - 16.0) * unit);
  for (std::size_t i = 0; i < buttons.size(); ++i) {
    const FooterButton& button = buttons[i];
    canvas.draw_button(button.id, {x, y, widths[i], kButtonHeight * unit}, button.label,
                       button.primary ? ButtonKind::primary : ButtonKind::plain, button.enabled);
    x += widths[i] + gap;
  }
}

Box draw_heading(Canvas& canvas, const std::string& title, const std::string& note,
                 std::uint32_t note_colour) {
  const double unit = canvas.unit();
  Box area = content_area(canvas);
  const double width = std::min(area.width, 1080.0 * unit);
  const double x = area.x + (area.width - width) / 2.0;
  const double height = std::min(canvas.measure(Letters::title, title, width), 150.0 * unit);
  canvas.draw_label({x, area.y, width, height}, Letters::title, tone::kText, title);
  double used_height = height;
  if (!note.empty()) {
    used_height += 6.0 * unit;
    const double line = canvas.measure(Letters::body, note, width);
    canvas.draw_label({x, area.y + used_height, width, line}, Letters::body, note_colour, note);
    used_height += line;
  }
  used_height += 18.0 * unit;
  area.y += used_height;
  area.height -= used_height;
  return area;
}

namespace {

/// The largest side of each of `count` pictures in a row or column, with space below each.
double max_side(double room, int count, double gap, double caption_height) {
  const double side = (room - gap * (count - 1)) / count - caption_height;
  if (kGapShare * side >= gap) return side;
  return (room - caption_height * count) / (count + kGapShare * (count - 1));
}

}  // namespace

PictureGrid lay_out_pictures(const std::vector<Vec2>& sizes, const Box& area, double gap,
                             double caption_height) {
  PictureGrid grid;
  const int count = static_cast<int>(sizes.size());
  if (count == 0) return grid;
  const Vec2 cell = max_size(sizes);
  grid.scale = 0.0;
  int best_rows = 1;
  for (int rows = 1; rows <= count; ++rows) {
    const int columns = (count + rows - 1) / rows;
    const double width_scale = max_side(area.width, columns, gap, 0.0) / cell.x;
    const double height_scale = max_side(area.height, rows, gap, caption_height) / cell.y;
    const double scale = std::min({1.0, width_scale, height_scale});
    if (scale > grid.scale + 1e-9) {
      grid.scale = scale;
      best_rows = rows;
    }
  }
  grid.scale = std::max(grid.scale, 0.01);
  const int columns = (count + best_rows - 1) / best_rows;
  const Vec2 size = grid.scale * cell;
  const bool fits = columns * size.x + (columns - 1) * gap <= area.width &&
                    best_rows * (size.y + caption_height) + (best_rows - 1) * gap <= area.height;
  if (!fits) gap = std::min(gap, kGapShare * std::min(size.x, size.y));
  const double row_height = size.y + caption_height;
  const double top = area.y + (area.height - best_rows * row_height - (best_rows - 1) * gap) / 2.0;
  for (int i = 0; i < count; ++i) {
    const int row = i / columns;
    const int columns_in_row = std::min(columns, count - row * columns);
    const double left =
        area.x + (area.width - columns_in_row * size.x - (columns_in_row - 1) * gap) / 2.0;
    const Vec2 picture_size = grid.scale * sizes[static_cast<std::size_t>(i)];
    grid.pictures.push_back(
        {left + (i % columns) * (size.x + gap) + (size.x - picture_size.x) / 2.0,
         top + row * (row_height + gap) + (size.y - picture_size.y) / 2.0, picture_size.x,
         picture_size.y});
  }
  return grid;
}

void draw_scale_bar(Canvas& canvas, const Box& room, const ScreenContext& context, double scale) {
  const Words& words = *context.words;
  const double unit = canvas.unit();
  const double length = scale * kBarMm / context.physical_scale->mm_per_unit;
  std::string text = words.scale_true;
  if (!context.physical_scale->is_known) {
    text = words.scale_unknown;
  } else if (scale < 0.995) {
    text = fill_numbers(words.scale_shrunk,
                        {{"percent", static_cast<int>(std::lround(100.0 * scale))}});
  }
  text = std::string(words.scale_bar) + "     " + text;
  const double gap = 12.0 * unit;
  const double letters =
      std::min(canvas.width_of(Letters::small, text) + unit, room.width - length - gap);
  const double x = std::round(room.x + (room.width - length - gap - letters) / 2.0);
  const double y = std::round(room.y + room.height / 2.0);
  const double thickness = std::max(1.0, std::round(2.0 * unit));
  const double tick = std::round(6.0 * unit);
  canvas.fill({x, y - thickness / 2.0, length, thickness}, tone::kText);
  canvas.fill({x, y - tick, thickness, 2.0 * tick}, tone::kText);
  canvas.fill({x + length - thickness, y - tick, thickness, 2.0 * tick}, tone::kText);
  canvas.draw_label({x + length + gap, room.y, letters, room.height}, Letters::small, tone::kQuiet,
                    text, Align::left);
}

}  // namespace touchtrial::app
