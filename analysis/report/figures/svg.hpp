/// \file Makes gnuplot's SVG accessible to screen readers, and its ids unique, so that several can
/// be embedded in one page.
#pragma once

#include "analysis/report/figures/figure.hpp"

#include <string>
#include <string_view>

namespace touchtrial::analysis {

/// The SVG file of a figure: with its own title and description for screen readers, the printed
/// size, and the figure's id as a prefix of every id; without tool tips (which quote the script)
/// and empty groups.
/// \param drawn  gnuplot's output
/// \throws Error if it is not gnuplot's SVG
[[nodiscard]] std::string accessible_svg(std::string_view drawn, const Figure& figure);

/// The svg element of a file, with `prefix` before every id and reference, so that several pictures
/// can share a page.
/// \return empty if there is no svg element, or if it contains a script
[[nodiscard]] std::string inline_svg(std::string_view file, const std::string& prefix);

}  // namespace touchtrial::analysis
