/// \file The files from which users redraw a figure in their own style.
#pragma once

#include "analysis/report/figures/figure.hpp"

#include <map>
#include <string>

namespace touchtrial::analysis {

/// The figure's data and scripts by file name: "<id>.csv", one row per row of a layer
/// (docs/report.md); "<id>.gp", the gnuplot script, which prints the SVG; "<id>.py" for matplotlib
/// and "<id>.r" for ggplot2, which read the CSV; and pictures of layers as "<id>-<layer>.png".
[[nodiscard]] std::map<std::string, std::string> redraw_files(const Figure& figure);

}  // namespace touchtrial::analysis
