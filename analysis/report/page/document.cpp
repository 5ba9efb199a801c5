#include "analysis/report/page/document.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace touchtrial::analysis {
namespace {

constexpr const char* kBetweenWords = ", ";

void add_sources(const Cited& cited, std::vector<Source>& references) {
  for (const Source source : cited.sources) {
    if (reference_number(source, references) == 0) references.push_back(source);
  }
}

void add_sources(const Table& table, std::vector<Source>& references) {
  for (const Cited& note : table.notes) add_sources(note, references);
}

void add_sources(const std::vector<Block>& blocks, std::vector<Source>& references) {
  for (const Block& block : blocks) {
    if (const auto* cited = std::get_if<Cited>(&block)) add_sources(*cited, references);
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
  for (const auto* some : {&section.blocks, &section.more}) {
    for (const Block& block : *some) blocks.push_back(&block);
  }
  return blocks;
}

std::size_t references_in_print(const Document& document) {
  std::vector<Source> references;
  for (const Section& section : document.sections) add_sources(section.blocks, references);
  return references.size();
}

std::vector<Source> references_of(const Document& document) {
  std::vector<Source> references;
  for (const Section& section : document.sections) add_sources(section.blocks, references);
  for (const Section& section : document.sections) add_sources(section.more, references);
  return references;
}

std::vector<Source> references_of(const Table& table) {
  std::vector<Source> references;
  add_sources(table, references);
  return references;
}

std::size_t reference_number(Source source, const std::vector<Source>& references) {
  const auto found = std::find(references.begin(), references.end(), source);
  if (found == references.end()) return 0;
  return static_cast<std::size_t>(found - references.begin()) + 1;
}

std::string citation_mark(const Cited& cited, const std::vector<Source>& references) {
  if (cited.sources.empty()) return "";
  std::string mark;
  for (const Source source : cited.sources) {
    mark += (mark.empty() ? " [" : ", ") + std::to_string(reference_number(source, references));
  }
  return mark + "]";
}

std::string stamped(const std::string& caption, const std::string& stamp) {
  std::string missing;
  for (std::size_t at = 0; at < stamp.size();) {
    const std::size_t end = std::min(stamp.find(kBetweenWords, at), stamp.size());
    const std::string word = stamp.substr(at, end - at);
    if (caption.find(word) == std::string::npos) {
      missing += (missing.empty() ? "" : kBetweenWords) + word;
    }
    at = end + std::string_view(kBetweenWords).size();
  }
  return missing.empty() ? caption : caption + " [" + missing + "]";
}

Document tables_alone(const Document& document) {
  Document alone = document;
  alone.header.entries.clear();
  for (Section& section : alone.sections) {
    std::ranges::move(section.more, std::back_inserter(section.blocks));
    section.more.clear();
    std::erase_if(section.blocks, [](const Block& block) {
      return !std::holds_alternative<Table>(block) && !std::holds_alternative<Warnings>(block);
    });
  }
  std::erase_if(alone.sections, [](const Section& section) { return section.blocks.empty(); });
  return alone;
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
