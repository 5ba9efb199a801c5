/// \file The layout of every screen: progress at the top, content in the middle, buttons at the
///   bottom; and rows of pictures.
#pragma once

#include "app/windows/participant/canvas.hpp"
#include "app/windows/participant/screen.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

/// The participant's progress; not drawn if `total` is 0.
struct Progress {
  int done = 0;  ///< finished items, for the bar
  int total = 0;
  std::string text;
};

/// The progress before a trial is answered.
/// \param trial  from 1 to `total`
[[nodiscard]] Progress progress_of(const Words& words, int trial, int total, bool practice);
void draw_progress(Canvas& canvas, const Progress& progress);

/// The pictures beside a card's text.
struct CardPictures {
  std::vector<std::string> names;  ///< names of the pictures, as on an instruction page
  PictureShelf* shelf = nullptr;   ///< provides pictures from files
};

/// The shelf's label for a picture on an instruction page.
[[nodiscard]] std::string page_picture(const std::string& name);

/// Draws title and text on a card in the middle of the content; letters shrink if necessary.
/// \param body  words between "**" are bold
/// \param note  small, below the text; may be empty
/// \param pictures  one below the other at the right of the text
void draw_card(Canvas& canvas, const std::string& title, const std::string& body,
               const std::string& note = "", Align align = Align::centre,
               const CardPictures& pictures = {});

/// Width and height of the drawing of the instructions, in any unit.
[[nodiscard]] Vec2 hand_drawing_size() noexcept;
void draw_hand(Canvas& canvas, const Box& box);

struct FooterButton {
  int id = 0;
  std::string label;
  bool primary = true;
  bool enabled = true;
};
/// Draws buttons in the footer: Next (kNextTarget) at a fixed place in the middle, and the other
/// buttons to its left, in order.
void draw_footer(Canvas& canvas, const std::vector<FooterButton>& buttons);

/// Draws a heading above the content.
/// \return the area that remains for the content
Box draw_heading(Canvas& canvas, const std::string& title, const std::string& note = "",
                 std::uint32_t note_colour = tone::kQuiet);

/// The positions and sizes of pictures.
struct PictureGrid {
  std::vector<Box> pictures;
  double scale = 1.0;  ///< 1 is true size, which is the maximum
};

/// Arranges pictures in the fewest rows that make them largest. If space is tight, the gap is at
/// most a quarter of a picture's side.
/// \param sizes  true sizes, window units
/// \param caption_height  window units that each picture needs below it
[[nodiscard]] PictureGrid lay_out_pictures(const std::vector<Vec2>& sizes, const Box& area,
                                           double gap, double caption_height);

/// Draws a bar of 10 mm at the scale of the pictures, and states that scale.
void draw_scale_bar(Canvas& canvas, const Box& room, const ScreenContext& context, double scale);

}  // namespace touchtrial::app
