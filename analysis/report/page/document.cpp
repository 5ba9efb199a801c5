#include "analysis/report/page/document.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace touchtrial::analysis {
namespace {

constexpr const char* kSeparator = ", ";

void add_sources(const CitedText& cited, std::vector<Source>& references) {
  for (const Source source : cited.sources) {
    if (reference_number(source, references) == 0) references.push_back(source);
  }
}

void add_sources(const Table& table, std::vector<Source>& references) {
  for (const CitedText& note : table.notes) add_sources(note, references);
}

void add_sources(const std::vector<Block>& blocks, std::vector<Source>& references) {
  for (const Block& block : blocks) {
    if (const auto* cited = std::get_if<CitedText>(&block)) add_sources(*cited, references);
    if (const auto* table = std::get_if<Table>(&block)) add_sources(*table, references);
  }
}

}  // namespace

std::vector<Column> columns_of(const std::vector<std::string>& titles,
                               const std::vector<std::string>& left) {
  std::vector<Column> columns;
  for (const std::string& title : titles) {
    const bool is_left = columns.empty() || std::ranges::find(left, title) != left.end();
    columns.push_back({title, is_left ? Align::left : Align::right});
  }
  return columns;
}

std::vector<const Block*> all_blocks(const Section& section) {
  std::vector<const Block*> blocks;
  for (const auto* list : {&section.blocks, &section.folded_blocks}) {
    for (const Block& block : *list) blocks.push_back(&block);
  }
  return blocks;
}

std::size_t printed_reference_count(const Document& document) {
  std::vector<Source> references;
  for (const Section& section : document.sections) add_sources(section.blocks, references);
  return references.size();
}

std::vector<Source> references_of(const Document& document) {
  std::vector<Source> references;
  for (const Section& section : document.sections) add_sources(section.blocks, references);
  for (const Section& section : document.sections) add_sources(section.folded_blocks, references);
  return references;
}

std::vector<Source> references_of(const Table& table) {
  std::vector<Source> references;
  add_sources(table, references);
  return references;
}

std::size_t reference_number(Source source, const std::vector<Source>& references) {
  const auto found = std::ranges::find(references, source);
  if (found == references.end()) return 0;
  return static_cast<std::size_t>(found - references.begin()) + 1;
}

std::string citation_mark(const CitedText& cited, const std::vector<Source>& references) {
  std::string mark;
  for (const Source source : cited.sources) {
    mark += (mark.empty() ? " [" : ", ") + std::to_string(reference_number(source, references));
  }
  return mark.empty() ? mark : mark + "]";
}

std::string stamped(const std::string& caption, const std::string& stamp) {
  std::string missing_words;
  for (std::size_t at = 0; at < stamp.size();) {
    const std::size_t end = std::min(stamp.find(kSeparator, at), stamp.size());
    const std::string word = stamp.substr(at, end - at);
    if (caption.find(word) == std::string::npos) {
      missing_words += (missing_words.empty() ? "" : kSeparator) + word;
    }
    at = end + std::string_view(kSeparator).size();
  }
  return missing_words.empty() ? caption : caption + " [" + missing_words + "]";
}

Document tables_only(const Document& document) {
  Document tables = document;
  tables.header.entries.clear();
  for (Section& section : tables.sections) {
    std::ranges::move(section.folded_blocks, std::back_inserter(section.blocks));
    section.folded_blocks.clear();
    std::erase_if(section.blocks, [](const Block& block) {
      return !std::holds_alternative<Table>(block) && !std::holds_alternative<Warnings>(block);
    });
  }
  std::erase_if(tables.sections, [](const Section& section) { return section.blocks.empty(); });
  return tables;
}

std::vector<const Table*> tables_of(const Document& document) {
  std::vector<const Table*> tables;
  for (const Section& section : document.sections) {
    for (const Block* block : all_blocks(section)) {
      if (const auto* table = std::get_if<Table>(block)) tables.push_back(table);
    }
  }
  return tables;
}

}  // namespace touchtrial::analysis
