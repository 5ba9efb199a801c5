/// \file Where things lie on every screen: progress above, the content in the middle, buttons
/// below; and pictures beside each other.
#pragma once

#include "app/windows/participant/canvas.hpp"
#include "app/windows/participant/screen.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

/// How far the participant is; not drawn if `of` is 0.
struct Progress {
  int done = 0;  ///< finished items, for the bar
  int of = 0;
  std::string text;
};

/// Before a trial is answered.
/// \param trial  from 1 to `of`
[[nodiscard]] Progress progress_of(const Words& words, int trial, int of, bool practice);
void draw_progress(Canvas& canvas, const Progress& progress);

/// What a card shows beside its text.
struct CardPictures {
  std::vector<std::string> names;  ///< as in a page of instructions
  PictureShelf* shelf = nullptr;   ///< of pictures that are files
};

/// The shelf's label of a page's picture.
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
/// Draws buttons in the footer: Next (kNextTarget) in the middle, where it stays when others come
/// and go, and the others to its left, in their order.
void draw_footer(Canvas& canvas, const std::vector<FooterButton>& buttons);

/// Draws a heading above the content.
/// \return the area that remains for the content
Box draw_heading(Canvas& canvas, const std::string& title, const std::string& note = "",
                 std::uint32_t note_colour = tone::kQuiet);

/// Where pictures lie, and how large they are.
struct PictureGrid {
  std::vector<Box> pictures;
  double shown = 1.0;  ///< scale: 1 is true size, which is the largest
};

/// Arranges pictures in the rows that leave them largest, and in as few rows as that allows. Where
/// there is no room for the gap, it is at most a quarter of a picture's side.
/// \param sizes  in window units, true to scale
/// \param below  window units that each picture needs below it
[[nodiscard]] PictureGrid lay_out_pictures(const std::vector<Vec2>& sizes, const Box& area,
                                           double gap, double below);

/// Draws a bar as long as 10 mm in the pictures, and says what their scale is.
void draw_scale_bar(Canvas& canvas, const Box& room, const ScreenContext& context, double shown);

}  // namespace touchtrial::app
