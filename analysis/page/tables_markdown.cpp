#include "analysis/escaping.hpp"
#include "analysis/page/document.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string line_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += ' ' + cell + " |";
  return line + '\n';
}

std::string row_of(const std::vector<Cell>& row) {
  std::vector<std::string> cells;
  for (const Cell& cell : row) {
    cells.push_back(cell.strong && !cell.text.empty() ? "**" + markdown_escaped(cell.text) + "**"
                                                      : markdown_escaped(cell.text));
  }
  return line_of(cells);
}

std::string table_text(const Table& table, const std::string& stamp,
                       const std::vector<Source>& references) {
  std::string text = "**" + markdown_escaped(stamped(table.caption, stamp)) + "**\n\n";
  std::vector<std::string> titles;
  std::vector<std::string> rules;
  for (const Column& column : table.columns) {
    titles.push_back(markdown_escaped(column.title));
    rules.emplace_back(column.align == Align::left ? ":---" : "---:");
  }
  text += line_of(titles) + line_of(rules);
  for (const std::vector<Cell>& row : table.rows) text += row_of(row);
  for (const Cited& note : table.notes) {
    text += '\n' + markdown_escaped(note.text) + markdown_escaped(citation_mark(note, references)) +
            '\n';
  }
  return text;
}

std::string references_text(const std::vector<Source>& references) {
  std::string text;
  for (std::size_t i = 0; i < references.size(); ++i) {
    text +=
        fmt::format("{}. {}\n", i + 1, markdown_escaped(std::string(citation_of(references[i]))));
  }
  return text;
}

std::string warnings_text(const Warnings& warnings) {
  std::string text;
  for (const std::string& one : warnings.sentences) text += "- " + markdown_escaped(one) + '\n';
  return text + '\n';
}

}  // namespace

std::string table_markdown(const Table& table, const std::string& stamp) {
  const std::vector<Source> references = references_of(table);
  std::string text = table_text(table, stamp, references);
  return references.empty() ? text : text + '\n' + references_text(references);
}

std::string tables_markdown(const Document& document) {
  const std::vector<Source> references = references_of(document);
  std::string text = "# " + markdown_escaped(stamped(document.title, document.stamp)) + "\n\n";
  for (const std::string& banner : document.banners)
    text += "**" + markdown_escaped(banner) + "**\n\n";
  for (const Section& section : document.sections) {
    if (!has_tables_or_warnings(section)) continue;
    text += "## " + markdown_escaped(section.title) + "\n\n";
    for (const Block& block : section.blocks) {
      if (const auto* warnings = std::get_if<Warnings>(&block)) text += warnings_text(*warnings);
      const auto* table = std::get_if<Table>(&block);
      if (table != nullptr) text += table_text(*table, document.stamp, references) + '\n';
    }
  }
  if (!references.empty()) text += "## References\n\n" + references_text(references);
  return text;
}

}  // namespace touchtrial::analysis
