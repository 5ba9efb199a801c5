#include "analysis/report/escaping.hpp"
#include "analysis/report/page/document.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kMaxFloatRows = 40;   ///< longer tables do not fit on a page
constexpr std::size_t kMaxCellLength = 40;  ///< longer texts are broken into lines

constexpr const char* kHeader =
    "% The preamble needs: \\usepackage[T1]{fontenc} \\usepackage[utf8]{inputenc} "
    "\\usepackage{textcomp,booktabs,longtable}\n";

std::string column_letter(const Table& table, std::size_t column) {
  std::size_t longest = 0;
  for (const auto& row : table.rows) longest = std::max(longest, row[column].text.size());
  if (longest > kMaxCellLength) return "p{0.4\\linewidth}";
  return table.columns[column].align == Align::left ? "l" : "r";
}

std::string column_letters(const Table& table) {
  std::string letters;
  for (std::size_t i = 0; i < table.columns.size(); ++i) letters += column_letter(table, i);
  return letters;
}

std::string titles_latex(const Table& table) {
  std::string line;
  for (const Column& column : table.columns) {
    line += (line.empty() ? "" : " & ") + latex_escaped(column.title);
  }
  return line + " \\\\\n";
}

std::string rows_latex(const Table& table) {
  std::string lines;
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string text = latex_escaped(row[i].text);
      lines += (i == 0 ? "" : " & ") + (row[i].strong ? "\\textbf{" + text + "}" : text);
    }
    lines += " \\\\\n";
  }
  return lines;
}

/// Where references are: beneath a table in a separate file, else at the end of the document.
enum class ReferencePlacement { document_end, beneath };

std::string references_beneath(const std::vector<Source>& references) {
  std::string text;
  for (std::size_t i = 0; i < references.size(); ++i) {
    text += "\\par\\noindent " +
            latex_escaped(fmt::format("[{}] {}", i + 1, citation_of(references[i]))) + "\n";
  }
  return text;
}

std::string notes_latex(const Table& table, const std::vector<Source>& references,
                        ReferencePlacement placement) {
  std::string text;
  for (const CitedText& note : table.notes) {
    text += "\\par\\smallskip\\noindent " + latex_escaped(note.text) +
            latex_escaped(citation_mark(note, references)) + "\n";
  }
  if (placement == ReferencePlacement::beneath) text += references_beneath(references);
  return text.empty()
             ? ""
             : "\\begin{minipage}{\\linewidth}\\footnotesize\n" + text + "\\end{minipage}\n";
}

/// The LaTeX commands for the type size: smaller for tables with many columns.
std::string size_of(const Table& table) {
  if (table.columns.size() > 9) return "\\scriptsize\\setlength{\\tabcolsep}{2.5pt}";
  return table.columns.size() > 6 ? "\\footnotesize\\setlength{\\tabcolsep}{3.5pt}" : "\\small";
}

std::string float_latex(const Table& table, const std::string& caption,
                        const std::vector<Source>& references, ReferencePlacement placement) {
  return fmt::format(
             "\\begin{{table}}[htbp]\n\\centering{}\n\\caption{{{}}}\n\\label{{tab:{}}}\n"
             "\\begin{{tabular}}{{@{{}}{}@{{}}}}\n\\toprule\n",
             size_of(table), caption, table.id, column_letters(table)) +
         titles_latex(table) + "\\midrule\n" + rows_latex(table) +
         "\\bottomrule\n\\end{tabular}\n\n" + notes_latex(table, references, placement) +
         "\\end{table}\n";
}

std::string longtable_latex(const Table& table, const std::string& caption,
                            const std::vector<Source>& references, ReferencePlacement placement) {
  return fmt::format(
             "{{{}\n\\begin{{longtable}}{{@{{}}{}@{{}}}}\n\\caption{{{}}}\\label{{tab:{}}}\\\\\n"
             "\\toprule\n",
             size_of(table), column_letters(table), caption, table.id) +
         titles_latex(table) + "\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n" +
         rows_latex(table) + "\\end{longtable}}\n" + notes_latex(table, references, placement);
}

std::string single_table(const Table& table, const std::string& stamp,
                         const std::vector<Source>& references, ReferencePlacement placement) {
  const std::string caption = latex_escaped(stamped(table.caption, stamp));
  return table.rows.size() > kMaxFloatRows ? longtable_latex(table, caption, references, placement)
                                           : float_latex(table, caption, references, placement);
}

std::string references_latex(const std::vector<Source>& references) {
  if (references.empty()) return "";
  std::string text = "\\begin{enumerate}\n";
  for (const Source source : references) {
    text += "\\item " + latex_escaped(std::string(citation_of(source))) + "\n";
  }
  return text + "\\end{enumerate}\n";
}

/// The references as a comment, for authors who replace the printed list.
std::string references_as_comment(const std::vector<Source>& references) {
  std::string text;
  for (std::size_t i = 0; i < references.size(); ++i) {
    text += fmt::format("% [{}] {}\n", i + 1, citation_of(references[i]));
  }
  return text;
}

std::string warnings_latex(const Warnings& warnings) {
  if (warnings.sentences.empty()) return "";
  std::string text = "\\begin{itemize}\n";
  for (const std::string& sentence : warnings.sentences)
    text += "\\item " + latex_escaped(sentence) + "\n";
  return text + "\\end{itemize}\n";
}

}  // namespace

std::string table_latex(const Table& table, const std::string& stamp) {
  const std::vector<Source> references = references_of(table);
  return kHeader + references_as_comment(references) +
         single_table(table, stamp, references, ReferencePlacement::beneath);
}

std::string tables_latex(const Document& document) {
  const Document tables = tables_only(document);
  const std::vector<Source> references = references_of(tables);
  std::string text = kHeader;
  for (const std::string& banner : tables.banners) {
    text += "\\noindent\\textbf{" + latex_escaped(banner) + "}\\par\\medskip\n";
  }
  for (const Section& section : tables.sections) {
    text += "\\section*{" + latex_escaped(section.title) + "}\n";
    for (const Block& block : section.blocks) {
      const auto* table = std::get_if<Table>(&block);
      text += table != nullptr
                  ? single_table(*table, tables.stamp, references, ReferencePlacement::document_end)
                  : warnings_latex(std::get<Warnings>(block));
    }
    text += "\\clearpage\n";
  }
  return references.empty() ? text
                            : text + "\\section*{References}\n" + references_latex(references);
}

}  // namespace touchtrial::analysis
