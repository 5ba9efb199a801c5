/// \file Any text as XML, HTML, Markdown or LaTeX that shows it as it is. Texts are UTF-8; labels
/// and reasons come from users and may contain anything.
#pragma once

#include <string>

namespace touchtrial::analysis {

/// For elements and quoted attributes of XML and HTML. Control characters become spaces.
[[nodiscard]] std::string xml_escaped(const std::string& text);

/// For GitHub's Markdown, on one line: line breaks and control characters become spaces.
[[nodiscard]] std::string markdown_escaped(const std::string& text);

/// For pdfLaTeX with T1 fonts: accented Latin letters and the signs that reports use. Any other
/// character shows as "[U+4E2D]"; control characters become spaces.
[[nodiscard]] std::string latex_escaped(const std::string& text);

}  // namespace touchtrial::analysis
