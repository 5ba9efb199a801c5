/// \file A figure of a report before it is drawn: what gnuplot is to do, and what a reader who does
/// not see it is told instead.
#pragma once

#include <string>
#include <vector>

namespace touchtrial::analysis {

struct Figure {
  std::string id;       ///< file name without extension: "accuracy-by-class"
  std::string caption;  ///< one sentence or two, with the intervals' method; stamped if simulated
  std::string alt;      ///< text alternative with the figures that matter
  std::string script;   ///< gnuplot, without terminal and output
  double width_cm = 16.0;
  double height_cm = 9.0;
};

enum class FigureFormat { svg, pdf };

/// Runs gnuplot: a whole SVG or PDF file. SVG has a title and a description for screen readers, no
/// script and nothing outside itself; equal figures give equal bytes.
/// \throws Error if gnuplot is not there or refuses the script
/// Thread-safe.
[[nodiscard]] std::string drawn(const Figure& figure, FigureFormat format);

}  // namespace touchtrial::analysis
