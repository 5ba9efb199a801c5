/// \file A drawn SVG file as a part of a page. Private to analysis/page.
#pragma once

#include <string>
#include <string_view>

namespace touchtrial::analysis {

/// The svg element without what stands before it in a file, its ids and references to them begun
/// with `prefix`, so that several pictures can be on one page.
/// \return empty if there is no svg element, or if it holds a script
[[nodiscard]] std::string inline_svg(std::string_view file, const std::string& prefix);

}  // namespace touchtrial::analysis
