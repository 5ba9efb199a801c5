/// \file gnuplot's SVG, described for screen readers and made fit to share a page with others.
#pragma once

#include "analysis/report/figures/figure.hpp"

#include <string>
#include <string_view>

namespace touchtrial::analysis {

/// A whole SVG file of a drawn figure: with a title and a description for screen readers instead of
/// gnuplot's own, with the size as printed, without tool tips (which quote the script) and empty
/// groups, and with the figure's id before every other id.
/// \param drawn  what gnuplot printed
/// \throws Error if that is not gnuplot's SVG
[[nodiscard]] std::string accessible_svg(std::string_view drawn, const Figure& figure);

/// The svg element of a file, without what precedes it, and with `prefix` before every id that it
/// gives or refers to, so that several pictures can share a page.
/// \return empty if there is no svg element, or if it contains a script
[[nodiscard]] std::string inline_svg(std::string_view file, const std::string& prefix);

}  // namespace touchtrial::analysis
