#include "app/windows/participant/canvas.hpp"

#include "app/windows/look.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <iterator>
#include <utility>

#include <imgui.h>

namespace touchtrial::app {
namespace {

constexpr double kSmall = 19.0;
constexpr double kBody = 24.0;
constexpr double kTitleSize = 38.0;
/// Letters shrink by this factor until they fit, down to the smallest size.
constexpr double kSmallerBy = 0.94;
constexpr double kSmallest = 0.4;

ImVec2 to_imgui(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}

/// The design's colours with high contrast: black, white, and dark shades of the others.
struct Contrasting {
  std::uint32_t usual;
  std::uint32_t high;
};
constexpr std::uint32_t kInk = 0xFF000000;
constexpr Contrasting kContrasting[] = {
    {tone::kGround, tone::kWhite}, {tone::kEdge, kInk},          {tone::kText, kInk},
    {tone::kQuiet, kInk},          {tone::kAccent, 0xFF6E2E00},  {tone::kAccentPale, 0xFFFFE6C8},
    {tone::kAccentDark, kInk},     {tone::kGood, 0xFF1E4B00},    {tone::kWarn, 0xFF00288C},
    {tone::kTrack, 0xFF969696},    {tone::kDisabled, 0xFFC8C8C8}};

}  // namespace

double design_unit(Vec2 size) noexcept {
  return std::max(0.4, std::min(size.x / 1280.0, size.y / 720.0));
}

Fonts load_participant_fonts(double unit, const std::set<char32_t>& letters) {
  const auto height = [unit](double size) { return static_cast<float>(std::round(size * unit)); };
  const std::array<FontSize, 4> sizes = {{{height(kSmall), FontWeight::regular},
                                          {height(kBody), FontWeight::regular},
                                          {height(kBody), FontWeight::bold},
                                          {height(kTitleSize), FontWeight::bold}}};
  const std::vector<ImFont*> loaded = load_letters(sizes, letters);
  return {loaded[0], loaded[1], loaded[2], loaded[3]};
}

Canvas::Canvas(ImDrawList& list, const Fonts& fonts, Vec2 size, const Attention& attention,
               bool high_contrast)
    : list_(list),
      fonts_(fonts),
      size_(size),
      unit_(design_unit(size)),
      attention_(attention),
      high_contrast_(high_contrast) {
  fill({0.0, 0.0, size.x, size.y}, tone::kGround);
}

ImFont* Canvas::font(Letters letters) const {
  switch (letters) {
    case Letters::small:
      return fonts_.small;
    case Letters::strong:
      return fonts_.strong;
    case Letters::title:
      return fonts_.title;
    case Letters::body:
    case Letters::rich:
      break;
  }
  return fonts_.body;
}

std::uint32_t Canvas::seen(std::uint32_t colour) const noexcept {
  if (!high_contrast_) return colour;
  const auto* const found = std::ranges::find(kContrasting, colour, &Contrasting::usual);
  return found == std::end(kContrasting) ? colour : found->high;
}

std::vector<TextLine> Canvas::lines(Letters letters, const std::string& text, double width,
                                    double shrink) const {
  const ImFont& face = *font(letters);
  const ImFont* const bold = letters == Letters::rich ? fonts_.strong : nullptr;
  return lines_of(text, face, bold, shrink * static_cast<double>(face.FontSize), width);
}

double Canvas::measure(Letters letters, const std::string& text, double width,
                       double shrink) const {
  return static_cast<double>(lines(letters, text, width, shrink).size()) *
         std::ceil(1.25 * shrink * static_cast<double>(font(letters)->FontSize));
}

void Canvas::look_for_missing(const ImFont& face, const std::string& text) {
  for (const char32_t letter : code_points(text)) {
    const bool is_there = letter <= U' ' || letter > IM_UNICODE_CODEPOINT_MAX ||
                          face.FindGlyphNoFallback(static_cast<ImWchar>(letter)) != nullptr;
    if (!is_there) missing_.insert(letter);
  }
}

double Canvas::width_of(Letters letters, const std::string& text) const {
  const ImFont& face = *font(letters);
  return static_cast<double>(face.CalcTextSizeA(face.FontSize, FLT_MAX, 0.0F, text.c_str()).x);
}

std::vector<TextLine> Canvas::balanced_lines(Letters letters, const std::string& text, double width,
                                             double shrink) const {
  std::vector<TextLine> best = lines(letters, text, width, shrink);
  if (best.size() < 2) return best;
  constexpr int kHalvings = 8;
  double narrow = 0.4 * width;
  double wide = width;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (narrow + wide);
    auto tried = lines(letters, text, middle, shrink);
    if (tried.size() > best.size()) {
      narrow = middle;
    } else {
      wide = middle;
      best = std::move(tried);
    }
  }
  return best;
}

void Canvas::draw_line(const TextLine& line, Letters letters, Vec2 at, double size,
                       std::uint32_t colour) {
  for (const TextRun& run : line.runs) {
    ImFont& face = run.bold ? *fonts_.strong : *font(letters);
    const bool is_bold = &face == fonts_.strong || &face == fonts_.title;
    look_for_missing(face, run.text);
    const auto draw = [&](double x) {
      list_.AddText(&face, static_cast<float>(size), to_imgui(x, at.y), colour, run.text.c_str());
    };
    draw(at.x + run.x);
    // East Asian letters have no bold face, so they are drawn twice with an offset.
    if (is_bold && std::ranges::any_of(code_points(run.text), is_east_asian)) {
      draw(at.x + run.x + std::max(1.0, std::round(size / 28.0)));
    }
  }
}

double Canvas::text(const Box& room, Letters letters, std::uint32_t colour, const std::string& text,
                    Align align, double shrink) {
  ImFont& face = *font(letters);
  const double size = shrink * static_cast<double>(face.FontSize);
  const double line_height = std::ceil(1.25 * size);
  double y = std::round(room.y);
  Box taken{room.right(), y, 0.0, 0.0};
  double right = room.x;
  const bool balances = align == Align::centre;
  for (const TextLine& line : balances ? balanced_lines(letters, text, room.width, shrink)
                                       : lines(letters, text, room.width, shrink)) {
    double x = room.x;
    if (align == Align::centre) x += (room.width - line.width) / 2.0;
    if (align == Align::right) x += room.width - line.width;
    draw_line(line, letters, {std::round(x), y + std::floor((line_height - size) / 2.0)}, size,
              seen(colour));
    if (line.width > 0.0) {
      taken.x = std::min(taken.x, x);
      right = std::max(right, x + line.width);
    }
    y += line_height;
  }
  taken.width = std::max(0.0, right - taken.x);
  taken.height = y - taken.y;
  texts_.push_back({text, taken, room});
  return taken.height;
}

void Canvas::label(const Box& room, Letters letters, std::uint32_t colour, const std::string& text,
                   Align align) {
  double shrink = 1.0;
  double height = measure(letters, text, room.width, shrink);
  while (height > room.height && shrink > kSmallest) {
    shrink *= kSmallerBy;
    height = measure(letters, text, room.width, shrink);
  }
  Box placed = room;
  placed.y = std::floor(room.y + (room.height - height) / 2.0);
  placed.height = height;
  this->text(placed, letters, colour, text, align, shrink);
}

void Canvas::fill(const Box& box, std::uint32_t colour, double rounding) {
  list_.AddRectFilled(to_imgui(box.x, box.y), to_imgui(box.right(), box.bottom()), seen(colour),
                      static_cast<float>(rounding));
}

void Canvas::curve(const std::array<Vec2, 4>& points, double thickness, std::uint32_t colour) {
  const auto at = [&points](std::size_t i) { return to_imgui(points[i].x, points[i].y); };
  const auto radius = static_cast<float>(thickness / 2.0);
  list_.AddBezierCubic(at(0), at(1), at(2), at(3), seen(colour), static_cast<float>(thickness), 32);
  list_.AddCircleFilled(at(0), radius, seen(colour), 32);
  list_.AddCircleFilled(at(3), radius, seen(colour), 32);
}

void Canvas::area(std::span<const Vec2> corners, std::uint32_t colour) {
  std::vector<ImVec2> points;
  for (const Vec2 corner : corners) points.push_back(to_imgui(corner.x, corner.y));
  list_.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), seen(colour));
}

void Canvas::clip_to(const Box& box) {
  list_.PushClipRect(to_imgui(box.x, box.y), to_imgui(box.right(), box.bottom()), true);
}

void Canvas::end_clip() {
  list_.PopClipRect();
}

void Canvas::outline(const Box& box, std::uint32_t colour, double thickness, double rounding) {
  list_.AddRect(to_imgui(box.x, box.y), to_imgui(box.right(), box.bottom()), seen(colour),
                static_cast<float>(rounding), 0, static_cast<float>(thickness));
}

void Canvas::focus_ring(int id, const Box& box, double rounding) {
  if (attention_.focus != id) return;
  outline(box.inset(-5.0 * unit_), tone::kAccent, 3.0 * unit_, rounding + 5.0 * unit_);
}

void Canvas::button(int id, const Box& box, const std::string& label, ButtonKind kind, bool enabled,
                    bool chosen) {
  const double rounding = 12.0 * unit_;
  const bool lit = enabled && attention_.hover == id;
  const bool filled = kind == ButtonKind::primary || chosen;
  std::uint32_t ground = filled ? tone::kAccent : tone::kCard;
  if (lit) ground = filled ? tone::kAccentDark : tone::kAccentPale;
  if (!enabled && !chosen) ground = tone::kDisabled;
  fill(box, ground, rounding);
  if (!filled) outline(box, lit ? tone::kAccent : tone::kEdge, 1.5 * unit_, rounding);
  std::uint32_t letters = filled ? tone::kWhite : tone::kText;
  if (!enabled && !chosen) letters = tone::kQuiet;
  const bool in_line = kind == ButtonKind::line;
  Box inside = box.inset(8.0 * unit_);
  if (in_line) {
    inside.x += 16.0 * unit_;
    inside.width -= 32.0 * unit_;
  }
  this->label(inside, kind == ButtonKind::primary ? Letters::strong : Letters::body, letters, label,
              in_line ? Align::left : Align::centre);
  if (!enabled) return;
  target(id, box);
  focus_ring(id, box, rounding);
}

void Canvas::picture(PictureShelf& shelf, const std::string& label, const Box& box) {
  const double x = std::round(box.x);
  const double y = std::round(box.y);
  const double width = std::round(box.width);
  const double height = std::round(box.height);
  void* const texture = shelf.texture(label, static_cast<int>(width), static_cast<int>(height));
  if (texture == nullptr) return fill({x, y, width, height}, tone::kTrack);
  list_.AddImage(texture, to_imgui(x, y), to_imgui(x + width, y + height));
}

}  // namespace touchtrial::app
