/// \file Any text as LaTeX. Private to analysis/page.
#pragma once

#include <string>

namespace touchtrial::analysis {

/// Text that pdfLaTeX prints as it is, with T1 fonts: accented Latin letters and the signs that
/// reports use. What it has no sign for shows as "[U+4E2D]", control characters as spaces.
[[nodiscard]] std::string latex_escaped(const std::string& text);

}  // namespace touchtrial::analysis
