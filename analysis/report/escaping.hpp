/// \file Escapes text so that XML, HTML, Markdown or LaTeX shows it unchanged. Texts are UTF-8;
/// labels and reasons come from users and may contain anything. Misleading characters are replaced
/// as in core/printable.hpp.
#pragma once

#include <string>

namespace touchtrial::analysis {

/// Escapes text for elements and quoted attributes of XML and HTML. Control characters become
/// spaces.
[[nodiscard]] std::string xml_escaped(const std::string& text);

/// Escapes text for one line of GitHub's Markdown. Line breaks and control characters become
/// spaces.
[[nodiscard]] std::string markdown_escaped(const std::string& text);

/// Escapes text for pdfLaTeX with T1 fonts. Accented Latin letters and the signs that reports use
/// are shown; any other character becomes its code, such as "[U+4E2D]". Control characters become
/// spaces.
[[nodiscard]] std::string latex_escaped(const std::string& text);

}  // namespace touchtrial::analysis
