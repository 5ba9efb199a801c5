#include "analysis/exports/data_table.hpp"

#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string quoted_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

struct CsvField {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const std::string& text) const { return quoted_field(text); }
  std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(std::chrono::nanoseconds time) const { return seconds_text(time); }
};

}  // namespace

std::string seconds_text(std::chrono::nanoseconds time) {
  constexpr std::uint64_t kPerSecond = 1'000'000'000;
  const bool negative = time.count() < 0;
  const auto count = static_cast<std::uint64_t>(time.count());
  const std::uint64_t size = negative ? 0 - count : count;
  std::string text =
      fmt::format("{}{}.{:09}", negative ? "-" : "", size / kPerSecond, size % kPerSecond);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string csv_text(const DataTable& table) {
  std::string text;
  const auto add_line = [&](const auto& fields, const auto& to_text) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (i > 0) text += ',';
      text += to_text(fields[i]);
    }
    text += '\n';
  };
  add_line(table.columns, [](const std::string& name) { return quoted_field(name); });
  for (const std::vector<DataCell>& row : table.rows) {
    if (row.size() != table.columns.size()) {
      throw std::invalid_argument("a row needs as many cells as the table has columns");
    }
    add_line(row, [](const DataCell& cell) { return std::visit(CsvField{}, cell); });
  }
  return text;
}

}  // namespace touchtrial::analysis
