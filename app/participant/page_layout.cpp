#include "app/participant/page_layout.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::app {
namespace {

constexpr double kPageMargin = 56.0;
constexpr double kTop = 68.0;
constexpr double kFooter = 124.0;
constexpr double kButtonHeight = 64.0;
constexpr double kCardWidth = 900.0;
constexpr double kSmallestLetters = 0.4;

}  // namespace

std::string with_numbers(const char* pattern, const std::vector<int>& numbers) {
  std::string text = pattern;
  std::size_t from = 0;
  for (const int number : numbers) {
    const std::size_t at = text.find("{}", from);
    if (at == std::string::npos) break;
    const std::string digits = std::to_string(number);
    text.replace(at, 2, digits);
    from = at + digits.size();
  }
  return text;
}

void draw_progress(Canvas& canvas, const Progress& progress) {
  if (progress.of <= 0) return;
  const double unit = canvas.unit();
  const double width = canvas.size().x;
  canvas.fill({0.0, 0.0, width, 6.0 * unit}, tone::kTrack);
  const double share = std::clamp(static_cast<double>(progress.done) / progress.of, 0.0, 1.0);
  canvas.fill({0.0, 0.0, width * share, 6.0 * unit}, tone::kAccent);
  canvas.text({kPageMargin * unit, 22.0 * unit, width - 2.0 * kPageMargin * unit, 30.0 * unit},
              Letters::small, tone::kQuiet, progress.text, Align::right);
}

Box content_area(const Canvas& canvas) {
  const double unit = canvas.unit();
  return {kPageMargin * unit, kTop * unit, canvas.size().x - 2.0 * kPageMargin * unit,
          canvas.size().y - (kTop + kFooter) * unit};
}

void draw_card(Canvas& canvas, const std::string& title, const std::string& body,
               const std::string& note, Align align) {
  const double unit = canvas.unit();
  const Box area = content_area(canvas);
  const double width = std::min(area.width, kCardWidth * unit);
  const double padding = 52.0 * unit;
  const double room = width - 2.0 * padding;
  const double gap = 22.0 * unit;
  const auto height_at = [&](double shrink) {
    double height = 2.0 * padding + canvas.measure(Letters::title, title, room, shrink);
    if (!body.empty()) height += gap + canvas.measure(Letters::body, body, room, shrink);
    if (!note.empty()) height += 1.4 * gap + canvas.measure(Letters::small, note, room, shrink);
    return height;
  };
  double shrink = 1.0;
  while (height_at(shrink) > area.height && shrink > kSmallestLetters) shrink *= 0.96;
  const double height = height_at(shrink);
  const Box card = {std::round(area.x + (area.width - width) / 2.0),
                    std::round(area.y + (area.height - height) / 2.0), width, height};
  canvas.fill(card, tone::kCard, 20.0 * unit);
  canvas.outline(card, tone::kEdge, unit, 20.0 * unit);
  Box line = {card.x + padding, card.y + padding, room, 0.0};
  const auto put = [&](Letters letters, std::uint32_t colour, const std::string& text) {
    line.height = card.bottom() - padding - line.y;
    line.y += canvas.text(line, letters, colour, text, align, shrink);
  };
  if (!title.empty()) put(Letters::title, tone::kText, title);
  if (!body.empty()) {
    if (!title.empty()) line.y += gap;
    put(Letters::body, tone::kText, body);
  }
  if (!note.empty()) {
    line.y += 1.4 * gap;
    put(Letters::small, tone::kQuiet, note);
  }
}

void draw_footer(Canvas& canvas, const std::vector<FooterButton>& buttons) {
  const double unit = canvas.unit();
  const double gap = 24.0 * unit;
  std::vector<double> widths;
  double total = -gap;
  for (const FooterButton& button : buttons) {
    const double letters =
        canvas.width_of(button.primary ? Letters::strong : Letters::body, button.label);
    widths.push_back(std::max(220.0 * unit, letters + 72.0 * unit));
    total += widths.back() + gap;
  }
  double x = std::round((canvas.size().x - total) / 2.0);
  const double y = std::round(canvas.size().y - (kFooter - 16.0) * unit);
  for (std::size_t i = 0; i < buttons.size(); ++i) {
    const FooterButton& button = buttons[i];
    canvas.button(button.id, {x, y, widths[i], kButtonHeight * unit}, button.label,
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
  canvas.label({x, area.y, width, height}, Letters::title, tone::kText, title);
  double used = height;
  if (!note.empty()) {
    used += 6.0 * unit;
    const double line = canvas.measure(Letters::body, note, width);
    canvas.label({x, area.y + used, width, line}, Letters::body, note_colour, note);
    used += line;
  }
  used += 18.0 * unit;
  area.y += used;
  area.height -= used;
  return area;
}

}  // namespace touchtrial::app
