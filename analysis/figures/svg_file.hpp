/// \file gnuplot's SVG made fit to stand in a page beside others. Private to figures.
#pragma once

#include "analysis/figures/figure.hpp"

#include <string>
#include <string_view>

namespace touchtrial::analysis {

/// A title and a description for screen readers in place of gnuplot's own, the size as printed,
/// tool tips (which quote the script) and empty groups left out, and every id with the figure's
/// before it, so that several figures can be embedded in one page.
/// \throws Error if it is no SVG of gnuplot's
[[nodiscard]] std::string accessible_svg(std::string_view drawn, const Figure& figure);

}  // namespace touchtrial::analysis
