#include "analysis/exports/data_table.hpp"

#include "core/printable.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string csv_field(const std::string& cell) {
  const std::string text = harmless_cell(cell);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

constexpr const char* kMissingTsv = "n/a";

std::string tsv_field(const std::string& text) {
  std::string field = text.empty() ? kMissingTsv : harmless_cell(text);
  std::replace_if(
      field.begin(), field.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
  return field;
}

/// A cell as text.
struct FieldText {
  std::string (*field)(const std::string&);
  const char* missing;

  std::string operator()(std::monostate) const { return missing; }
  std::string operator()(const std::string& text) const { return field(text); }
  std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(std::chrono::nanoseconds time) const { return seconds_text(time); }
};

std::string table_text(const DataTable& table, char separator, const FieldText& to_text) {
  std::string text;
  const auto add_line = [&](const auto& fields, const auto& field_text) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (i > 0) text += separator;
      text += field_text(fields[i]);
    }
    text += '\n';
  };
  add_line(table.columns, to_text.field);
  for (const std::vector<DataCell>& row : table.rows) {
    if (row.size() != table.columns.size()) {
      throw std::invalid_argument("a row needs as many cells as the table has columns");
    }
    add_line(row, [&](const DataCell& cell) { return std::visit(to_text, cell); });
  }
  return text;
}

}  // namespace

DataCell utc_cell(std::chrono::nanoseconds at, bool simulated) {
  return simulated ? DataCell() : DataCell(utc_text(at));
}

DataCell flag(bool value) {
  return std::int64_t{value ? 1 : 0};
}

std::string seconds_text(std::chrono::nanoseconds time) {
  constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;
  const bool is_negative = time.count() < 0;
  const auto count = static_cast<std::uint64_t>(time.count());
  const std::uint64_t magnitude = is_negative ? 0 - count : count;
  std::string text =
      fmt::format("{}{}.{:09}", is_negative ? "-" : "", magnitude / kNanosecondsPerSecond,
                  magnitude % kNanosecondsPerSecond);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string harmless_cell(const std::string& text) {
  const std::string printed = printable(text);
  return begins_like_formula(text) && !number_in<double>(text) ? "'" + printed : printed;
}

std::string r_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string csv_text(const DataTable& table) {
  return table_text(table, ',', {csv_field, ""});
}

std::string tsv_text(const DataTable& table) {
  return table_text(table, '\t', {tsv_field, kMissingTsv});
}

}  // namespace touchtrial::analysis
