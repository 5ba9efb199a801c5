/// \file Where things lie on every screen: progress above, one thing in the middle, buttons below.
#pragma once

#include "app/participant/canvas.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

/// How far along; nothing is drawn where `of` is 0.
struct Progress {
  int done = 0;  ///< finished ones, for the bar
  int of = 0;
  std::string text;
};

void draw_progress(Canvas& canvas, const Progress& progress);

/// Between progress and buttons.
[[nodiscard]] Box content_area(const Canvas& canvas);

/// Title and text on a card in the middle of the content area; letters get smaller if they must.
/// \param note  small, below the rest; may be empty
void draw_card(Canvas& canvas, const std::string& title, const std::string& body,
               const std::string& note = "", Align align = Align::centre);

struct FooterButton {
  int id = 0;
  std::string label;
  bool primary = true;
  bool enabled = true;
};
/// In the middle of the footer, from left to right.
void draw_footer(Canvas& canvas, const std::vector<FooterButton>& buttons);

/// A heading above the content. \return the content area that is left below it
Box draw_heading(Canvas& canvas, const std::string& title, const std::string& note = "",
                 std::uint32_t note_colour = tone::kQuiet);

/// \param pattern  each "{}" is replaced by the next number
[[nodiscard]] std::string with_numbers(const char* pattern, const std::vector<int>& numbers);

}  // namespace touchtrial::app
