/// \file What the figures share: one look, legible in print, and with any colour vision.
#pragma once

#include "bench/figures/figures.hpp"

#include <string>
#include <utility>
#include <vector>

namespace touchtrial::bench {

/// A figure's size, in pixels.
struct FigureSize {
  int width;
  int height;
};

/// Terminal, fonts, borders and grid.
[[nodiscard]] std::string figure_head(Format format, FigureSize size);

/// Colours by Okabe and Ito.
enum class Colour { blue, vermilion, green, purple, orange, sky, black };

/// gnuplot's filled marks, then the open ones.
enum class Mark {
  disc = 7,
  square = 5,
  triangle = 9,
  inverted = 11,
  diamond = 13,
  circle = 6,
  open_square = 4,
  open_triangle = 8,
  cross = 2
};

struct Curve {
  std::string title;
  Colour colour;
  Mark mark;
  std::vector<std::pair<double, double>> points;
};

/// "plot .." of curves with their data before it; those without points are left out.
/// \param style  "points", "lines" or "linespoints"
[[nodiscard]] std::string plot_of(const std::vector<Curve>& curves, const std::string& style);

}  // namespace touchtrial::bench
