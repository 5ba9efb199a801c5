// The document as text for a terminal.
#include "analysis/page/document.hpp"
#include "analysis/text_table.hpp"

#include <utility>

namespace touchtrial::analysis {
namespace {

std::string titled(const std::string& title) {
  return "\n" + title + "\n";
}

struct BlockText {
  const std::string& stamp;

  std::string operator()(const Cited& cited) const { return wrapped("  ", cited.text); }
  std::string operator()(const Table& table) const {
    std::vector<std::string> header;
    for (const Column& column : table.columns) header.push_back(column.title);
    TextTable text(header);
    for (const std::vector<Cell>& row : table.rows) {
      std::vector<std::string> cells;
      for (const Cell& cell : row) cells.push_back(cell.text);
      text.add(std::move(cells));
    }
    std::string shown = titled(stamped(table.caption, stamp)) + text.text();
    for (const Cited& note : table.notes) shown += wrapped("  ", note.text);
    return shown;
  }
  std::string operator()(const Picture&) const { return ""; }
  std::string operator()(const Subheading& heading) const { return titled(heading.title); }
  std::string operator()(const Warnings& warnings) const {
    std::string text;
    for (const std::string& one : warnings.sentences) text += wrapped("  - ", one);
    return text;
  }
  std::string operator()(const Definitions& definitions) const {
    std::string text;
    for (const auto& [name, meaning] : definitions.entries) {
      text += wrapped("  " + name + ": ", meaning);
    }
    return text;
  }
  std::string operator()(const Flow& flow) const {
    std::string text = titled(stamped(flow.caption, stamp));
    for (const FlowStep& step : flow.steps) {
      text += wrapped("  ", step.text);
      for (const std::string& leaving : step.leaving) text += wrapped("    - ", leaving);
    }
    return text;
  }
};

}  // namespace

std::string document_text(const Document& document) {
  std::string text = stamped(document.title, document.stamp) + "\n";
  for (const std::string& banner : document.banners) text += wrapped("", banner);
  for (const Section& section : document.sections) {
    text += titled(section.title);
    for (const Block& block : section.blocks) text += std::visit(BlockText{document.stamp}, block);
  }
  return text;
}

}  // namespace touchtrial::analysis
