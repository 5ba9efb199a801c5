/// \file The files with which users redraw a figure in their own style.
#pragma once

#include "analysis/report/figures/figure.hpp"

#include <map>
#include <string>

namespace touchtrial::analysis {

/// The figure's data and scripts by the names of their files: "<id>.csv", one row for each row of
/// each layer (docs/report.md); "<id>.gp", gnuplot's script, which prints the SVG; "<id>.py" for
/// matplotlib and "<id>.r" for ggplot2, which read the CSV beside them; and pictures of layers as
/// "<id>-<layer>.png".
[[nodiscard]] std::map<std::string, std::string> redraw_files(const Figure& figure);

}  // namespace touchtrial::analysis
