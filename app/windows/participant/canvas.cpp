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
constexpr double kShrinkFactor = 0.94;
constexpr double kMinShrink = 0.4;

ImVec2 to_imgui(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}

/// The design's colours with high contrast: black, white, and dark shades of the others.
struct ContrastPair {
  std::uint32_t usual;
  std::uint32_t high;
};
constexpr std::uint32_t kInk = 0xFF000000;
constexpr ContrastPair kContrastPairs[] = {
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
  const std::vector<ImFont*> loaded_fonts = load_letters(sizes, letters);
  return {loaded_fonts[0], loaded_fonts[1], loaded_fonts[2], loaded_fonts[3]};
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

std::uint32_t Canvas::contrast_colour(std::uint32_t colour) const noexcept {
  if (!high_contrast_) return colour;
  const auto* const pair = std::ranges::find(kContrastPairs, colour, &ContrastPair::usual);
  return pair == std::end(kContrastPairs) ? colour : pair->high;
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

void Canvas::collect_missing_letters(const ImFont& face, const std::string& text) {
  for (const char32_t letter : code_points(text)) {
    const bool has_glyph = letter <= U' ' || letter > IM_UNICODE_CODEPOINT_MAX ||
                           face.FindGlyphNoFallback(static_cast<ImWchar>(letter)) != nullptr;
    if (!has_glyph) missing_letters_.insert(letter);
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
    auto candidate = lines(letters, text, middle, shrink);
    if (candidate.size() > best.size()) {
      narrow = middle;
    } else {
      wide = middle;
      best = std::move(candidate);
    }
  }
  return best;
}

void Canvas::draw_line(const TextLine& line, Letters letters, Vec2 at, double size,
                       std::uint32_t colour) {
  for (const TextRun& run : line.runs) {
    ImFont& face = run.bold ? *fonts_.strong : *font(letters);
    const bool is_bold = &face == fonts_.strong || &face == fonts_.title;
    collect_missing_letters(face, run.text);
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

double Canvas::draw_text(const Box& room, Letters letters, std::uint32_t colour,
                         const std::string& text, Align align, double shrink) {
  ImFont& face = *font(letters);
  const double size = shrink * static_cast<double>(face.FontSize);
  const double line_height = std::ceil(1.25 * size);
  double y = std::round(room.y);
  Box text_box{room.right(), y, 0.0, 0.0};
  double right = room.x;
  const bool is_balanced = align == Align::centre;
  for (const TextLine& line : is_balanced ? balanced_lines(letters, text, room.width, shrink)
                                          : lines(letters, text, room.width, shrink)) {
    double x = room.x;
    if (align == Align::centre) x += (room.width - line.width) / 2.0;
    if (align == Align::right) x += room.width - line.width;
    draw_line(line, letters, {std::round(x), y + std::floor((line_height - size) / 2.0)}, size,
              contrast_colour(colour));
    if (line.width > 0.0) {
      text_box.x = std::min(text_box.x, x);
      right = std::max(right, x + line.width);
    }
    y += line_height;
  }
  text_box.width = std::max(0.0, right - text_box.x);
  text_box.height = y - text_box.y;
  texts_.push_back({text, text_box, room});
  return text_box.height;
}

void Canvas::draw_label(const Box& room, Letters letters, std::uint32_t colour,
                        const std::string& text, Align align) {
  double shrink = 1.0;
  double height = measure(letters, text, room.width, shrink);
  while (height > room.height && shrink > kMinShrink) {
    shrink *= kShrinkFactor;
    height = measure(letters, text, room.width, shrink);
  }
  Box line_box = room;
  line_box.y = std::floor(room.y + (room.height - height) / 2.0);
  line_box.height = height;
  draw_text(line_box, letters, colour, text, align, shrink);
}

void Canvas::fill(const Box& box, std::uint32_t colour, double rounding) {
  list_.AddRectFilled(to_imgui(box.x, box.y), to_imgui(box.right(), box.bottom()),
                      contrast_colour(colour), static_cast<float>(rounding));
}

void Canvas::draw_curve(const std::array<Vec2, 4>& points, double thickness, std::uint32_t colour) {
  const auto at = [&points](std::size_t i) { return to_imgui(points[i].x, points[i].y); };
  const auto radius = static_cast<float>(thickness / 2.0);
  list_.AddBezierCubic(at(0), at(1), at(2), at(3), contrast_colour(colour),
                       static_cast<float>(thickness), 32);
  list_.AddCircleFilled(at(0), radius, contrast_colour(colour), 32);
  list_.AddCircleFilled(at(3), radius, contrast_colour(colour), 32);
}

void Canvas::fill_area(std::span<const Vec2> corners, std::uint32_t colour) {
  std::vector<ImVec2> points;
  for (const Vec2 corner : corners) points.push_back(to_imgui(corner.x, corner.y));
  list_.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()),
                            contrast_colour(colour));
}

void Canvas::clip_to(const Box& box) {
  list_.PushClipRect(to_imgui(box.x, box.y), to_imgui(box.right(), box.bottom()), true);
}

void Canvas::end_clip() {
  list_.PopClipRect();
}

void Canvas::outline(const Box& box, std::uint32_t colour, double thickness, double rounding) {
  list_.AddRect(to_imgui(box.x, box.y), to_imgui(box.right(), box.bottom()),
                contrast_colour(colour), static_cast<float>(rounding), 0,
                static_cast<float>(thickness));
}

void Canvas::draw_focus_ring(int id, const Box& box, double rounding) {
  if (attention_.focus != id) return;
  outline(box.inset(-5.0 * unit_), tone::kAccent, 3.0 * unit_, rounding + 5.0 * unit_);
}

void Canvas::draw_button(int id, const Box& box, const std::string& label, ButtonKind kind,
                         bool enabled, bool chosen) {
  const double rounding = 12.0 * unit_;
  const bool is_hovered = enabled && attention_.hover == id;
  const bool is_filled = kind == ButtonKind::primary || chosen;
  std::uint32_t ground = is_filled ? tone::kAccent : tone::kCard;
  if (is_hovered) ground = is_filled ? tone::kAccentDark : tone::kAccentPale;
  if (!enabled && !chosen) ground = tone::kDisabled;
  fill(box, ground, rounding);
  if (!is_filled) outline(box, is_hovered ? tone::kAccent : tone::kEdge, 1.5 * unit_, rounding);
  std::uint32_t letters = is_filled ? tone::kWhite : tone::kText;
  if (!enabled && !chosen) letters = tone::kQuiet;
  const bool is_line = kind == ButtonKind::line;
  Box inside = box.inset(8.0 * unit_);
  if (is_line) {
    inside.x += 16.0 * unit_;
    inside.width -= 32.0 * unit_;
  }
  draw_label(inside, kind == ButtonKind::primary ? Letters::strong : Letters::body, letters, label,
             is_line ? Align::left : Align::centre);
  if (!enabled) return;
  add_target(id, box);
  draw_focus_ring(id, box, rounding);
}

void Canvas::draw_picture(PictureShelf& shelf, const std::string& label, const Box& box) {
  const double x = std::round(box.x);
  const double y = std::round(box.y);
  const double width = std::round(box.width);
  const double height = std::round(box.height);
  void* const texture = shelf.texture(label, static_cast<int>(width), static_cast<int>(height));
  if (texture == nullptr) return fill({x, y, width, height}, tone::kTrack);
  list_.AddImage(texture, to_imgui(x, y), to_imgui(x + width, y + height));
}

}  // namespace touchtrial::app
