#include "analysis/exports/bids/bids_tsv.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr const char* kMissing = "n/a";

struct TsvField {
  std::string operator()(std::monostate) const { return kMissing; }
  std::string operator()(const std::string& text) const {
    if (text.empty()) return kMissing;
    std::string field = text;
    std::replace_if(
        field.begin(), field.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; },
        ' ');
    return field;
  }
  std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(std::chrono::nanoseconds time) const { return seconds_text(time); }
};

}  // namespace

std::string tsv_text(const DataTable& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.columns, "\t"));
  for (const std::vector<DataCell>& row : table.rows) {
    if (row.size() != table.columns.size()) {
      throw std::invalid_argument("a row needs as many cells as the table has columns");
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += '\t';
      text += std::visit(TsvField{}, row[i]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace touchtrial::analysis
