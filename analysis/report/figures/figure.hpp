/// \file A figure before it is drawn: what gnuplot does, and what readers who do not see it are
/// told instead; and drawing it.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

struct Figure {
  std::string id;       ///< file name without extension: "accuracy-by-class"
  std::string caption;  ///< one sentence or two, with the intervals' method; stamped if simulated
  std::string alt;      ///< text alternative with the main numbers
  std::string script;   ///< for gnuplot, without terminal and output
  double width_cm = 16.0;
  double height_cm = 9.0;
  std::string section{};  ///< id of the section or subheading below which it stands; empty: no page
};

enum class FigureFormat { svg, pdf };

/// Runs gnuplot. An SVG file has a title and a description for screen readers, and no script or
/// reference to other files. Equal figures give equal bytes.
/// \return the whole SVG or PDF file
/// \throws Error if gnuplot is not installed or refuses the script
/// Thread-safe.
[[nodiscard]] std::string drawn(const Figure& figure, FigureFormat format);

/// Draws every figure, several at the same time.
/// \return the files, in the order of the figures
/// \throws Error as `drawn`
/// Thread-safe.
[[nodiscard]] std::vector<std::string> all_drawn(std::span<const Figure> figures,
                                                 FigureFormat format);

}  // namespace touchtrial::analysis
