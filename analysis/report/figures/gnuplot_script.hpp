/// \file gnuplot scripts.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/figures/layout.hpp"

#include <string>

namespace touchtrial::analysis {

/// The script that draws a figure, without terminal and output. It contains the data; no text of
/// the figure can end a string or a block of data.
[[nodiscard]] std::string gnuplot_script(const Figure& figure, const Layout& layout);

/// The line that sets size, fonts and pens, so that both formats look alike.
[[nodiscard]] std::string gnuplot_terminal(const Figure& figure, const Layout& layout,
                                           FigureFormat format);

/// The stops of the colour scale, from low to high: viridis, which is perceptually uniform, also
/// for colour-blind readers. Source: Smith and van der Walt, matplotlib.
[[nodiscard]] const std::vector<std::string>& colour_stops();

}  // namespace touchtrial::analysis
