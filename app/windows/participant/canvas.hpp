/// \file The drawing functions of the participant's screens: measured text, buttons, pictures.
#pragma once

#include "app/windows/text_flow.hpp"
#include "core/vec.hpp"

#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

struct ImDrawList;
struct ImFont;

namespace touchtrial::app {

/// A rectangle in window units from the top-left corner.
struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  [[nodiscard]] constexpr double right() const noexcept { return x + width; }
  [[nodiscard]] constexpr double bottom() const noexcept { return y + height; }
  [[nodiscard]] constexpr bool contains(Vec2 point) const noexcept {
    return point.x >= x && point.y >= y && point.x < right() && point.y < bottom();
  }
  /// Shrinks the box on every side.
  [[nodiscard]] constexpr Box inset(double margin) const noexcept {
    return {x + margin, y + margin, width - 2.0 * margin, height - 2.0 * margin};
  }
};

/// Colours as ImGui packs them: 0xAABBGGRR.
namespace tone {
inline constexpr std::uint32_t kGround =
    0xFFECEAE8;  ///< the same for all screens, to avoid flashes
inline constexpr std::uint32_t kCard = 0xFFFFFFFF;
inline constexpr std::uint32_t kEdge = 0xFFD2CDC8;
inline constexpr std::uint32_t kText = 0xFF332A22;
inline constexpr std::uint32_t kQuiet = 0xFF6B6158;  ///< contrast of 5 : 1 on the ground
inline constexpr std::uint32_t kAccent = 0xFF99580B;
inline constexpr std::uint32_t kAccentPale = 0xFFF6E9DC;
inline constexpr std::uint32_t kAccentDark = 0xFF754308;
inline constexpr std::uint32_t kGood = 0xFF4F7A0A;
inline constexpr std::uint32_t kWarn = 0xFF0B4FB4;
inline constexpr std::uint32_t kTrack = 0xFFD6D1CC;
inline constexpr std::uint32_t kDisabled = 0xFFDEDAD7;
inline constexpr std::uint32_t kWhite = 0xFFFFFFFF;
}  // namespace tone

enum class Letters {
  small,
  body,
  rich,  ///< body, with words between "**" in bold
  strong,
  title,
};
enum class Align { left, centre, right };
enum class ButtonKind {
  primary,
  plain,
  choice,
  line,  ///< a choice with left-aligned text
};

/// Fonts for one scale, in ImGui's current context.
struct Fonts {
  ImFont* small = nullptr;
  ImFont* body = nullptr;
  ImFont* strong = nullptr;
  ImFont* title = nullptr;
};

/// \return window units per design unit; the design's window is 1280 x 720 units
[[nodiscard]] double design_unit(Vec2 size) noexcept;

/// Replaces the fonts of the current context, as load_letters.
/// \param unit  design_unit times the letters' scale
[[nodiscard]] Fonts load_participant_fonts(double unit, const std::set<char32_t>& letters = {});

/// Provides pictures as textures.
class PictureShelf {
 public:
  virtual ~PictureShelf() = default;
  /// \param label  label of the picture
  /// \return width and height, mm
  [[nodiscard]] virtual Vec2 size_mm(const std::string& label) const = 0;
  /// \param width,height  window units
  /// \return ImGui's texture of the picture at this size; null: draw a blank
  [[nodiscard]] virtual void* texture(const std::string& label, int width, int height) = 0;
};

/// An element that can be clicked or chosen by keys.
struct Target {
  int id = 0;
  Box box;
};

struct PlacedText {
  std::string text;
  Box box;   ///< occupied by the letters
  Box room;  ///< available
};

/// The targets in focus, hovered or held; -1: none.
struct Attention {
  int focus = -1;  ///< chosen by keys
  int hover = -1;  ///< under the pointer
  int held = -1;   ///< pressed by the mouse button
};

/// One frame of the window, within a frame of ImGui. Belongs to the drawing thread.
class Canvas {
 public:
  /// \param high_contrast  black on white in place of the design's colours
  Canvas(ImDrawList& list, const Fonts& fonts, Vec2 size, const Attention& attention,
         bool high_contrast = false);

  [[nodiscard]] Vec2 size() const noexcept { return size_; }
  [[nodiscard]] double unit() const noexcept { return unit_; }

  /// \return the height of the wrapped text
  double measure(Letters letters, const std::string& text, double width, double shrink = 1.0) const;
  [[nodiscard]] double width_of(Letters letters, const std::string& text) const;
  /// Draws text from the top of the room, wrapped at its width.
  /// \return the height of the text
  double draw_text(const Box& room, Letters letters, std::uint32_t colour, const std::string& text,
                   Align align = Align::centre, double shrink = 1.0);
  /// Draws lines in the middle of the room's height; letters shrink if the room is too small.
  void draw_label(const Box& room, Letters letters, std::uint32_t colour, const std::string& text,
                  Align align = Align::centre);

  void fill(const Box& box, std::uint32_t colour, double rounding = 0.0);
  void outline(const Box& box, std::uint32_t colour, double thickness, double rounding = 0.0);
  /// A line with round ends: a cubic Bezier curve through its first and last point.
  void draw_curve(const std::array<Vec2, 4>& points, double thickness, std::uint32_t colour);
  /// \param corners  corners of a convex area, clockwise
  void fill_area(std::span<const Vec2> corners, std::uint32_t colour);
  /// Clips drawing to the box until `end_clip`.
  void clip_to(const Box& box);
  void end_clip();
  void draw_button(int id, const Box& box, const std::string& label, ButtonKind kind,
                   bool enabled = true, bool chosen = false);
  /// Draws a ring around the box if the target has the focus.
  void draw_focus_ring(int id, const Box& box, double rounding);
  void add_target(int id, const Box& box) { targets_.push_back({id, box}); }
  void draw_picture(PictureShelf& shelf, const std::string& label, const Box& box);

  [[nodiscard]] const Attention& attention() const noexcept { return attention_; }
  [[nodiscard]] const std::vector<Target>& targets() const noexcept { return targets_; }
  [[nodiscard]] const std::vector<PlacedText>& texts() const noexcept { return texts_; }
  /// Letters of the texts that the fonts lack.
  [[nodiscard]] const std::set<char32_t>& missing_letters() const noexcept {
    return missing_letters_;
  }

 private:
  [[nodiscard]] ImFont* font(Letters letters) const;
  [[nodiscard]] std::vector<TextLine> lines(Letters letters, const std::string& text, double width,
                                            double shrink) const;
  /// Breaks text into the fewest lines of similar widths, so that no word is alone on the last one.
  [[nodiscard]] std::vector<TextLine> balanced_lines(Letters letters, const std::string& text,
                                                     double width, double shrink) const;
  void draw_line(const TextLine& line, Letters letters, Vec2 at, double size, std::uint32_t colour);
  /// The colour as drawn: replaced for high contrast.
  [[nodiscard]] std::uint32_t contrast_colour(std::uint32_t colour) const noexcept;
  void collect_missing_letters(const ImFont& face, const std::string& text);

  ImDrawList& list_;
  Fonts fonts_;
  Vec2 size_;
  double unit_;
  Attention attention_;
  bool high_contrast_;
  std::vector<Target> targets_;
  std::vector<PlacedText> texts_;
  std::set<char32_t> missing_letters_;
};

}  // namespace touchtrial::app
