#include "analysis/page/renderings.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Text that shows as it is; line breaks become spaces, as a row is one line.
std::string escaped_markdown(const std::string& text) {
  constexpr std::string_view kMarkup = "\\`*_{}[]<>#|~&!$^";
  std::string safe;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (kMarkup.find(c) != std::string_view::npos) safe += '\\';
    safe += code < 0x20 || code == 0x7f ? ' ' : c;
  }
  return safe;
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += ' ' + cell + " |";
  return line + '\n';
}

std::string row_of(const std::vector<Cell>& row) {
  std::vector<std::string> cells;
  for (const Cell& cell : row) {
    cells.push_back(cell.strong && !cell.text.empty() ? "**" + escaped_markdown(cell.text) + "**"
                                                      : escaped_markdown(cell.text));
  }
  return line_of(cells);
}

std::string table_text(const Table& table, const std::string& stamp,
                       const std::vector<Source>& references) {
  std::string text = "**" + escaped_markdown(stamped(table.caption, stamp)) + "**\n\n";
  std::vector<std::string> titles;
  std::vector<std::string> rules;
  for (const Column& column : table.columns) {
    titles.push_back(escaped_markdown(column.title));
    rules.emplace_back(column.align == Align::left ? ":---" : "---:");
  }
  text += line_of(titles) + line_of(rules);
  for (const std::vector<Cell>& row : table.rows) text += row_of(row);
  for (const Cited& note : table.notes) {
    text += '\n' + escaped_markdown(note.text) + escaped_markdown(citation_mark(note, references)) +
            '\n';
  }
  return text;
}

std::string references_text(const std::vector<Source>& references) {
  std::string text;
  for (std::size_t i = 0; i < references.size(); ++i) {
    text +=
        fmt::format("{}. {}\n", i + 1, escaped_markdown(std::string(citation_of(references[i]))));
  }
  return text;
}

std::string warnings_text(const Warnings& warnings) {
  std::string text;
  for (const std::string& one : warnings.sentences) text += "- " + escaped_markdown(one) + '\n';
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
  std::string text = "# " + escaped_markdown(stamped(document.title, document.stamp)) + "\n\n";
  for (const std::string& banner : document.banners)
    text += "**" + escaped_markdown(banner) + "**\n\n";
  for (const Section& section : document.sections) {
    if (!has_tables_or_warnings(section)) continue;
    text += "## " + escaped_markdown(section.title) + "\n\n";
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
