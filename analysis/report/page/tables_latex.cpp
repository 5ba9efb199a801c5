#include "analysis/report/escaping.hpp"
#include "analysis/report/page/document.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kLongRows = 40;  ///< longer tables do not fit on a page
constexpr std::size_t kWideCell = 40;  ///< longer texts are broken into lines

std::string header_of(const std::string& packages) {
  return "% The preamble needs: " + packages + "\n";
}

constexpr const char* kPackages =
    "\\usepackage[T1]{fontenc} \\usepackage[utf8]{inputenc} "
    "\\usepackage{textcomp,booktabs,longtable}";

std::string column_letter(const Table& table, std::size_t column) {
  std::size_t longest = 0;
  for (const std::vector<Cell>& row : table.rows) {
    longest = std::max(longest, row[column].text.size());
  }
  if (longest > kWideCell) return "p{0.4\\linewidth}";
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

/// Where references stand: a table in a file of its own has them beneath it.
enum class References { elsewhere, beneath };

std::string references_beneath(const std::vector<Source>& references) {
  std::string text;
  for (std::size_t i = 0; i < references.size(); ++i) {
    text += "\\par\\noindent " +
            latex_escaped(fmt::format("[{}] {}", i + 1, citation_of(references[i]))) + "\n";
  }
  return text;
}

std::string notes_latex(const Table& table, const std::vector<Source>& references,
                        References where) {
  std::string text;
  for (const Cited& note : table.notes) {
    text += "\\par\\smallskip\\noindent " + latex_escaped(note.text) +
            latex_escaped(citation_mark(note, references)) + "\n";
  }
  if (where == References::beneath) text += references_beneath(references);
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
                        const std::vector<Source>& references, References where) {
  return fmt::format(
             "\\begin{{table}}[htbp]\n\\centering{}\n\\caption{{{}}}\n\\label{{tab:{}}}\n"
             "\\begin{{tabular}}{{@{{}}{}@{{}}}}\n\\toprule\n",
             size_of(table), caption, table.id, column_letters(table)) +
         titles_latex(table) + "\\midrule\n" + rows_latex(table) +
         "\\bottomrule\n\\end{tabular}\n\n" + notes_latex(table, references, where) +
         "\\end{table}\n";
}

std::string long_latex(const Table& table, const std::string& caption,
                       const std::vector<Source>& references, References where) {
  return fmt::format(
             "{{{}\n\\begin{{longtable}}{{@{{}}{}@{{}}}}\n\\caption{{{}}}\\label{{tab:{}}}\\\\\n"
             "\\toprule\n",
             size_of(table), column_letters(table), caption, table.id) +
         titles_latex(table) + "\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n" +
         rows_latex(table) + "\\end{longtable}}\n" + notes_latex(table, references, where);
}

std::string one_table(const Table& table, const std::string& stamp,
                      const std::vector<Source>& references, References where) {
  const std::string caption = latex_escaped(stamped(table.caption, stamp));
  return table.rows.size() > kLongRows ? long_latex(table, caption, references, where)
                                       : float_latex(table, caption, references, where);
}

std::string references_latex(const std::vector<Source>& references) {
  if (references.empty()) return "";
  std::string text = "\\begin{enumerate}\n";
  for (const Source source : references) {
    text += "\\item " + latex_escaped(std::string(citation_of(source))) + "\n";
  }
  return text + "\\end{enumerate}\n";
}

/// The references again as a comment, for authors who replace the printed list by their own.
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
  for (const std::string& one : warnings.sentences) text += "\\item " + latex_escaped(one) + "\n";
  return text + "\\end{itemize}\n";
}

}  // namespace

std::string table_latex(const Table& table, const std::string& stamp) {
  const std::vector<Source> references = references_of(table);
  return header_of(kPackages) + references_as_comment(references) +
         one_table(table, stamp, references, References::beneath);
}

std::string tables_latex(const Document& document) {
  const Document alone = tables_alone(document);
  const std::vector<Source> references = references_of(alone);
  std::string text = header_of(kPackages);
  for (const std::string& banner : alone.banners) {
    text += "\\noindent\\textbf{" + latex_escaped(banner) + "}\\par\\medskip\n";
  }
  for (const Section& section : alone.sections) {
    text += "\\section*{" + latex_escaped(section.title) + "}\n";
    for (const Block& block : section.blocks) {
      const auto* table = std::get_if<Table>(&block);
      text += table != nullptr ? one_table(*table, alone.stamp, references, References::elsewhere)
                               : warnings_latex(std::get<Warnings>(block));
    }
    text += "\\clearpage\n";
  }
  return references.empty() ? text
                            : text + "\\section*{References}\n" + references_latex(references);
}

}  // namespace touchtrial::analysis
