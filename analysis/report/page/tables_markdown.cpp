#include "analysis/report/escaping.hpp"
#include "analysis/report/page/document.hpp"
#include "analysis/report/text_table.hpp"

#include <cstddef>

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

constexpr std::size_t kMarkdownWidth = 110;
constexpr std::size_t kUnwrapped = std::string::npos;

std::string table_text(const Table& table, const std::string& stamp,
                       const std::vector<Source>& references, std::size_t width = kUnwrapped) {
  std::string text =
      wrapped("", "**" + markdown_escaped(stamped(table.caption, stamp)) + "**", width) + '\n';
  std::vector<std::string> titles;
  std::vector<std::string> rules;
  for (const Column& column : table.columns) {
    titles.push_back(markdown_escaped(column.title));
    rules.emplace_back(column.align == Align::left ? ":---" : "---:");
  }
  text += line_of(titles) + line_of(rules);
  for (const std::vector<Cell>& row : table.rows) text += row_of(row);
  for (const CitedText& note : table.notes) {
    text +=
        '\n' +
        wrapped("", markdown_escaped(note.text) + markdown_escaped(citation_mark(note, references)),
                width);
  }
  return text;
}

std::string references_text(const std::vector<Source>& references, std::size_t width = kUnwrapped) {
  std::string text;
  for (std::size_t i = 0; i < references.size(); ++i) {
    text += wrapped(fmt::format("{}. ", i + 1),
                    markdown_escaped(std::string(citation_of(references[i]))), width);
  }
  return text;
}

std::string warnings_text(const Warnings& warnings) {
  std::string text;
  for (const std::string& sentence : warnings.sentences)
    text += "- " + markdown_escaped(sentence) + '\n';
  return text + '\n';
}

/// Blocks in Markdown, each followed by an empty line.
struct MarkdownWriter {
  const Document& document;
  const std::string& pictures;
  std::vector<Source> references;

  [[nodiscard]] std::string operator()(const CitedText& paragraph) const {
    return wrapped("",
                   markdown_escaped(paragraph.text) +
                       markdown_escaped(citation_mark(paragraph, references)),
                   kMarkdownWidth) +
           '\n';
  }
  [[nodiscard]] std::string operator()(const Table& table) const {
    return table_text(table, document.stamp, references, kMarkdownWidth) + '\n';
  }
  [[nodiscard]] std::string operator()(const Picture& picture) const {
    if (picture.svg.empty()) return (*this)(CitedText{"Not drawn: " + picture.alt});
    return "![" + markdown_escaped(picture.alt) + "](" + pictures + '/' + picture.id + ".svg)\n\n" +
           (*this)(CitedText{stamped(picture.caption, document.stamp)});
  }
  [[nodiscard]] std::string operator()(const Subheading& heading) const {
    return "### " + markdown_escaped(heading.title) + "\n\n";
  }
  [[nodiscard]] std::string operator()(const Warnings& warnings) const {
    return warnings_text(warnings);
  }
  [[nodiscard]] std::string operator()(const Definitions& definitions) const {
    std::string text;
    for (const auto& [name, meaning] : definitions.entries) {
      text += "- " + markdown_escaped(name) + ": " + markdown_escaped(meaning) + '\n';
    }
    return text + '\n';
  }
  [[nodiscard]] std::string operator()(const Flow& flow) const {
    std::string text;
    for (const FlowStep& step : flow.steps) {
      text += "- " + markdown_escaped(step.text) + '\n';
      for (const std::string& loss : step.losses) text += "  - " + markdown_escaped(loss) + '\n';
    }
    return text + '\n' + (*this)(CitedText{stamped(flow.caption, document.stamp)});
  }
};

}  // namespace

std::string document_markdown(const Document& document, const std::string& pictures) {
  const MarkdownWriter writer{document, pictures, references_of(document)};
  std::string text = "# " + markdown_escaped(stamped(document.title, document.stamp)) + "\n\n";
  for (const std::string& banner : document.banners)
    text += "**" + markdown_escaped(banner) + "**\n\n";
  if (!document.header.entries.empty()) text += writer(document.header);
  for (const Section& section : document.sections) {
    text += "## " + markdown_escaped(section.title) + "\n\n";
    for (const Block* block : all_blocks(section)) text += std::visit(writer, *block);
  }
  if (!writer.references.empty()) {
    text += "## References\n\n" + references_text(writer.references, kMarkdownWidth) + '\n';
  }
  return text + markdown_escaped(document.colophon) + '\n';
}

std::string table_markdown(const Table& table, const std::string& stamp) {
  const std::vector<Source> references = references_of(table);
  std::string text = table_text(table, stamp, references);
  return references.empty() ? text : text + '\n' + references_text(references);
}

}  // namespace touchtrial::analysis
