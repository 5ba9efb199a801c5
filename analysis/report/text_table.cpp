#include "analysis/report/text_table.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::string_view kIndent = "  ";
constexpr std::string_view kGap = "  ";

bool is_continuation_byte(char c) {
  return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
}

std::string left_aligned(std::string_view text, std::size_t width) {
  return fmt::format("{:<{}}", text, width);
}

std::string right_aligned(std::string_view text, std::size_t width) {
  return fmt::format("{:>{}}", text, width);
}

}  // namespace

std::size_t display_width(std::string_view text) {
  // Measures a text by padding it with fmt, so that measuring and padding agree on every character.
  const std::size_t padded_width = 2 * text.size() + 1;
  return padded_width - (left_aligned(text, padded_width).size() - text.size());
}

std::string fitted(std::string_view text, std::size_t width) {
  if (display_width(text) <= width) return std::string(text);
  while (!text.empty() && display_width(text) + 1 > width) {
    std::size_t end = text.size() - 1;
    while (end > 0 && is_continuation_byte(text[end])) --end;
    text = text.substr(0, end);
  }
  return std::string(text) + "…";
}

std::vector<std::string> lines_of(std::string_view paragraph, std::size_t width) {
  std::vector<std::string> lines(1);
  bool is_empty = true;
  while (!paragraph.empty()) {
    const std::size_t space = std::min(paragraph.find(' '), paragraph.size());
    const std::string_view word = paragraph.substr(0, space);
    if (!is_empty && display_width(lines.back()) + 1 + display_width(word) > width) {
      lines.emplace_back();
      is_empty = true;
    }
    if (!is_empty) lines.back() += ' ';
    lines.back() += word;
    is_empty = false;
    paragraph.remove_prefix(std::min(space + 1, paragraph.size()));
  }
  return lines;
}

std::string wrapped(std::string_view first, std::string_view paragraph, std::size_t width) {
  const std::size_t indent = display_width(first);
  std::string all;
  for (const std::string& line : lines_of(paragraph, std::max(width, indent) - indent)) {
    all += (all.empty() ? std::string(first) : std::string(indent, ' ')) + line + '\n';
  }
  return all;
}

TextTable::TextTable(std::vector<std::string> header, std::set<std::size_t> left)
    : left_(std::move(left)) {
  if (header.empty()) throw std::invalid_argument("a table needs a column");
  rows_.push_back(std::move(header));
  for (std::string& cell : rows_.front()) cell = fitted(cell, kCellWidth);
}

void TextTable::add(std::vector<std::string> cells) {
  if (cells.size() != rows_.front().size()) {
    throw std::invalid_argument("a row needs as many cells as the header has");
  }
  for (std::string& cell : cells) cell = fitted(cell, kCellWidth);
  rows_.push_back(std::move(cells));
}

std::vector<std::size_t> TextTable::column_widths() const {
  std::vector<std::size_t> widths(rows_.front().size());
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], display_width(row[i]));
    }
  }
  return widths;
}

std::string TextTable::text(std::size_t width) const {
  const std::vector<std::size_t> widths = column_widths();
  std::string all;
  std::size_t begin = 1;
  do {
    std::size_t used_width = kIndent.size() + widths[0];
    std::size_t end = begin;
    while (end < widths.size() &&
           (end == begin || used_width + kGap.size() + widths[end] <= width)) {
      used_width += kGap.size() + widths[end++];
    }
    for (const auto& row : rows_) {
      std::string line = std::string(kIndent) + left_aligned(row[0], widths[0]);
      for (std::size_t i = begin; i < end; ++i) {
        line += kGap;
        line +=
            left_.contains(i) ? left_aligned(row[i], widths[i]) : right_aligned(row[i], widths[i]);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      if (!line.empty()) all += line + '\n';
    }
    begin = end;
  } while (begin < widths.size());
  return all;
}

}  // namespace touchtrial::analysis
