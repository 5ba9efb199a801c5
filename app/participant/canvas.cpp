#include "app/participant/canvas.hpp"

#include "app/windows/look.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

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

/// The lines of a text, as ImGui wraps it.
std::vector<std::string> wrapped(const ImFont& font, const std::string& text, float scale,
                                 float width) {
  std::vector<std::string> lines;
  const char* at = text.c_str();
  const char* const end = at + text.size();
  while (at < end) {
    const char* stop = font.CalcWordWrapPositionA(scale, at, end, width);
    const char* const newline = std::find(at, stop, '\n');
    if (newline != stop) stop = newline;
    // Take at least one letter, however narrow the room is.
    if (stop == at && *at != '\n') {
      ++stop;
      while (stop < end && (static_cast<unsigned char>(*stop) & 0xC0U) == 0x80U) ++stop;
    }
    lines.emplace_back(at, stop);
    at = stop;
    if (at < end && *at == '\n') {
      ++at;
    } else {
      while (at < end && *at == ' ') ++at;
    }
  }
  return lines;
}

/// As few lines as the width allows, of similar widths, so that no word is alone on the last line.
std::vector<std::string> balanced(const ImFont& font, const std::string& text, float scale,
                                  double width) {
  std::vector<std::string> lines = wrapped(font, text, scale, static_cast<float>(width));
  if (lines.size() < 2) return lines;
  constexpr int kHalvings = 8;
  double narrow = 0.4 * width;
  double wide = width;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (narrow + wide);
    auto tried = wrapped(font, text, scale, static_cast<float>(middle));
    if (tried.size() > lines.size()) {
      narrow = middle;
    } else {
      wide = middle;
      lines = std::move(tried);
    }
  }
  return lines;
}

}  // namespace

double design_unit(Vec2 size) noexcept {
  return std::max(0.4, std::min(size.x / 1280.0, size.y / 720.0));
}

Fonts load_participant_fonts(double unit) {
  ImGui::GetIO().Fonts->Clear();
  const auto height = [unit](double size) { return static_cast<float>(std::round(size * unit)); };
  Fonts fonts;
  fonts.body = add_font(height(kBody), FontWeight::regular);
  fonts.small = add_font(height(kSmall), FontWeight::regular);
  fonts.strong = add_font(height(kBody), FontWeight::bold);
  fonts.title = add_font(height(kTitleSize), FontWeight::bold);
  return fonts;
}

Canvas::Canvas(ImDrawList& list, const Fonts& fonts, Vec2 size, const Attention& attention)
    : list_(list), fonts_(fonts), size_(size), unit_(design_unit(size)), attention_(attention) {
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
      break;
  }
  return fonts_.body;
}

double Canvas::measure(Letters letters, const std::string& text, double width,
                       double shrink) const {
  const ImFont& face = *font(letters);
  const auto lines = wrapped(face, text, static_cast<float>(shrink), static_cast<float>(width));
  return static_cast<double>(lines.size()) * std::ceil(1.25 * shrink * face.FontSize);
}

double Canvas::width_of(Letters letters, const std::string& text) const {
  const ImFont& face = *font(letters);
  return static_cast<double>(face.CalcTextSizeA(face.FontSize, FLT_MAX, 0.0F, text.c_str()).x);
}

double Canvas::text(const Box& room, Letters letters, std::uint32_t colour, const std::string& text,
                    Align align, double shrink) {
  ImFont& face = *font(letters);
  const double size = shrink * static_cast<double>(face.FontSize);
  const double line_height = std::ceil(1.25 * size);
  double y = std::round(room.y);
  Box taken{room.right(), y, 0.0, 0.0};
  double right = room.x;
  const auto lines =
      align == Align::centre
          ? balanced(face, text, static_cast<float>(shrink), room.width)
          : wrapped(face, text, static_cast<float>(shrink), static_cast<float>(room.width));
  for (const std::string& line : lines) {
    const double width = static_cast<double>(
        face.CalcTextSizeA(static_cast<float>(size), FLT_MAX, 0.0F, line.c_str()).x);
    double x = room.x;
    if (align == Align::centre) x += (room.width - width) / 2.0;
    if (align == Align::right) x += room.width - width;
    list_.AddText(&face, static_cast<float>(size),
                  to_imgui(std::round(x), y + std::floor((line_height - size) / 2.0)), colour,
                  line.c_str());
    if (width > 0.0) {
      taken.x = std::min(taken.x, x);
      right = std::max(right, x + width);
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
  list_.AddRectFilled(to_imgui(box.x, box.y), to_imgui(box.right(), box.bottom()), colour,
                      static_cast<float>(rounding));
}

void Canvas::outline(const Box& box, std::uint32_t colour, double thickness, double rounding) {
  list_.AddRect(to_imgui(box.x, box.y), to_imgui(box.right(), box.bottom()), colour,
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
