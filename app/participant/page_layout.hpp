/// \file Where things lie on every screen: progress above, the content in the middle, buttons
/// below; and pictures beside each other.
#pragma once

#include "app/participant/canvas.hpp"
#include "app/participant/screen.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

/// How far the participant is; not drawn if `of` is 0.
struct Progress {
  int done = 0;  ///< finished items, for the bar
  int of = 0;
  std::string text;
};

void draw_progress(Canvas& canvas, const Progress& progress);

/// Draws title and text on a card in the middle of the content; letters shrink if necessary.
/// \param note  small, below the text; may be empty
void draw_card(Canvas& canvas, const std::string& title, const std::string& body,
               const std::string& note = "", Align align = Align::centre);

struct FooterButton {
  int id = 0;
  std::string label;
  bool primary = true;
  bool enabled = true;
};
/// Draws buttons in the middle of the footer, from left to right.
void draw_footer(Canvas& canvas, const std::vector<FooterButton>& buttons);

/// Draws a heading above the content.
/// \return the area that remains for the content
Box draw_heading(Canvas& canvas, const std::string& title, const std::string& note = "",
                 std::uint32_t note_colour = tone::kQuiet);

/// \param pattern  each "{}" is replaced by the next number
[[nodiscard]] std::string with_numbers(const char* pattern, const std::vector<int>& numbers);

/// Where pictures lie, and how large they are.
struct PictureGrid {
  std::vector<Box> pictures;
  double shown = 1.0;  ///< scale: 1 is true size, which is the largest
};

/// Arranges pictures in the rows that leave them largest, and in as few rows as that allows.
/// \param sizes  in window units, true to scale
/// \param below  window units that each picture needs below it
[[nodiscard]] PictureGrid lay_out_pictures(const std::vector<Vec2>& sizes, const Box& area,
                                           double gap, double below);

/// Draws a bar of 10 mm in the pictures' scale, and says what that scale is.
void draw_scale_bar(Canvas& canvas, const Box& room, const ScreenContext& context, double shown);

}  // namespace touchtrial::app
