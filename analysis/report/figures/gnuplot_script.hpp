/// \file The one writer of gnuplot's scripts.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/figures/layout.hpp"

#include <string>

namespace touchtrial::analysis {

/// What gnuplot does to draw a figure: everything but terminal and output. Data are in the script,
/// and no text of the figure can end a string or a block of data.
[[nodiscard]] std::string gnuplot_script(const Figure& figure, const Layout& layout);

/// The line that sets the size, fonts and pens of a format, so that both look alike.
[[nodiscard]] std::string gnuplot_terminal(const Figure& figure, const Layout& layout,
                                           FigureFormat format);

/// The stops of the colour scale, from low to high: viridis, which runs evenly from dark to bright
/// for every kind of sight. Source: Smith and van der Walt, matplotlib.
[[nodiscard]] const std::vector<std::string>& colour_stops();

}  // namespace touchtrial::analysis
