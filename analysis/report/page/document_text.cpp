// The document as text for a terminal.
#include "analysis/report/page/document.hpp"
#include "analysis/report/text_table.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kTitleLines = 3;  ///< maximum for a column's title, unless a word is too long

using Row = std::vector<std::string>;

/// The texts of cells, the header first.
std::vector<Row> texts_of(const Table& table) {
  std::vector<Row> rows(1);
  for (const Column& column : table.columns) rows.front().push_back(column.title);
  for (const std::vector<Cell>& cells : table.rows) {
    Row& row = rows.emplace_back();
    for (const Cell& cell : cells) row.push_back((cell.strong ? "*" : "") + cell.text);
  }
  return rows;
}

/// The width of the longest cell, or more if the title needs it.
std::size_t width_of(const std::vector<Row>& rows, std::size_t column) {
  const std::string& title = rows.front()[column];
  std::size_t width = 1;
  for (const std::string& word : lines_of(title, 1)) width = std::max(width, display_width(word));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    width = std::max(width, display_width(rows[i][column]));
  }
  while (width < kCellWidth && lines_of(title, width).size() > kTitleLines) ++width;
  return std::min(width, kCellWidth);
}

/// Wraps the cells of one row.
/// \param is_header  aligns cells at the bottom
std::vector<Row> lines_of_row(const Row& row, const std::vector<std::size_t>& widths,
                              bool is_header) {
  std::vector<Row> cells;
  std::size_t height = 1;
  for (std::size_t i = 0; i < row.size(); ++i) {
    cells.push_back(lines_of(row[i], widths[i]));
    height = std::max(height, cells.back().size());
  }
  std::vector<Row> lines(height, Row(row.size()));
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::size_t first = is_header ? height - cells[i].size() : 0;
    for (std::size_t k = 0; k < cells[i].size(); ++k) lines[first + k][i] = cells[i][k];
  }
  return lines;
}

std::string table_text(const Table& table, std::size_t width) {
  const std::vector<Row> rows = texts_of(table);
  std::vector<std::size_t> widths;
  std::set<std::size_t> left{0};
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    widths.push_back(width_of(rows, i));
    if (table.columns[i].align == Align::left) left.insert(i);
  }
  std::vector<Row> lines;
  for (const Row& row : rows) {
    std::ranges::move(lines_of_row(row, widths, lines.empty()), std::back_inserter(lines));
  }
  TextTable text(lines.front(), std::move(left));
  for (std::size_t i = 1; i < lines.size(); ++i) text.add(lines[i]);
  return text.text(width);
}

/// Renders blocks.
class BlockText {
 public:
  BlockText(const std::string& stamp, std::size_t width) : stamp_(stamp), width_(width) {}

  std::string operator()(const CitedText& cited) const {
    return paragraph("  ", cited.lead.empty() ? cited.text : cited.lead + ' ' + cited.text);
  }
  std::string operator()(const Table& table) const {
    std::string text = caption(table.caption) + table_text(table, width_);
    for (const CitedText& note : table.notes) {
      if (note.sources.empty()) text += paragraph("  ", note.text);
    }
    return text;
  }
  std::string operator()(const Picture&) const { return ""; }
  std::string operator()(const Subheading&) const { return ""; }
  std::string operator()(const Warnings& warnings) const {
    std::string text = warnings.title.empty() ? "" : paragraph("  ", warnings.title);
    for (const std::string& sentence : warnings.sentences) text += paragraph("  - ", sentence);
    return text;
  }
  std::string operator()(const Definitions& definitions) const {
    std::string text;
    for (const auto& [name, meaning] : definitions.entries) {
      text += paragraph("    ", name + ": " + meaning).substr(2);
    }
    return text;
  }
  std::string operator()(const Flow& flow) const {
    std::string text = caption(flow.caption);
    for (const FlowStep& step : flow.steps) {
      text += paragraph("  ", step.text);
      for (const std::string& loss : step.losses) text += paragraph("    - ", loss);
    }
    return text;
  }

 private:
  [[nodiscard]] std::string caption(const std::string& text) const {
    return '\n' + paragraph(stamp_.empty() ? "" : '[' + stamp_ + "] ", text);
  }
  [[nodiscard]] std::string paragraph(std::string_view first, const std::string& text) const {
    return wrapped(first, text, width_);
  }

  const std::string& stamp_;
  std::size_t width_;
};

std::string section_title(const std::string& title, const std::string& stamp) {
  const std::string line = stamped(title, stamp);
  return '\n' + line + '\n' + std::string(display_width(line), '-') + '\n';
}

}  // namespace

std::string document_text(const Document& document, std::size_t width) {
  std::string text;
  for (const std::string& banner : document.banners) text += wrapped("", banner, width);
  text += wrapped("", stamped(document.title, document.stamp), width);
  const BlockText blocks(document.stamp, width);
  for (const Section& section : document.sections) {
    if (section.page_only || section.blocks.empty()) continue;
    text += section_title(section.title, document.stamp);
    for (const Block& block : section.blocks) text += std::visit(blocks, block);
    for (const Block& block : section.folded_blocks) {
      if (const auto* warnings = std::get_if<Warnings>(&block)) text += blocks(*warnings);
    }
  }
  if (!document.header.entries.empty()) {
    text += section_title(document.about, document.stamp) + blocks(document.header);
  }
  if (!document.stamp.empty()) text += '\n' + document.stamp + '\n';
  return text;
}

}  // namespace touchtrial::analysis
