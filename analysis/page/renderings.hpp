/// \file A document as files: HTML to read, Markdown and LaTeX to take tables from. Equal documents
/// give equal bytes. All functions may be called from any thread.
#pragma once

#include "analysis/page/document.hpp"

#include <string>

namespace touchtrial::analysis {

/// One page that needs nothing outside itself and no script.
[[nodiscard]] std::string page_html(const Document& document);

/// One table as GitHub's Markdown, with its notes and their references.
[[nodiscard]] std::string table_markdown(const Table& table, const std::string& stamp);
/// Every table of the document under its section's title, and the references at the end.
[[nodiscard]] std::string tables_markdown(const Document& document);

/// One table as LaTeX for \input: a float (longtable if it is long) for which the preamble needs
/// booktabs, longtable, and for pdfLaTeX T1 fonts and UTF-8 input.
[[nodiscard]] std::string table_latex(const Table& table, const std::string& stamp);
/// Every table of the document in sections, and the references at the end; for \input too.
[[nodiscard]] std::string tables_latex(const Document& document);

}  // namespace touchtrial::analysis
