/// \file Numbers of a report, each described once: the member of results.json, the title and the
/// cells of a table's column, and the note that says what it is. Tables and JSON objects are made
/// of lists of them. All functions are thread-safe.
#pragma once

#include "analysis/report/json_figures.hpp"
#include "analysis/report/page/document.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// One number of every `Row`.
template <typename Row>
struct Measure {
  std::string member;  ///< of results.json; empty: for tables alone
  std::string title;   ///< of the column; empty: for results.json alone
  std::function<nlohmann::ordered_json(const Row&)> json;
  std::function<Cell(const Row&)> cell;
  Align align = Align::right;
  std::vector<Cited> notes{};  ///< stand below a table that has the column
  bool only_known = false;     ///< leave the column out if no row has the number

  /// The same number with a note.
  [[nodiscard]] Measure with(std::string text, std::vector<Source> sources = {}) && {
    notes.push_back({std::move(text), std::move(sources)});
    return std::move(*this);
  }
  [[nodiscard]] Measure if_known() && {
    only_known = true;
    return std::move(*this);
  }
};

template <typename Row>
using MeasureList = std::vector<Measure<Row>>;

/// \name Kinds of measures. `get` takes a row.
/// \{

template <typename Row, typename Get>
[[nodiscard]] Measure<Row> label_of(std::string member, std::string title, Get get) {
  return {std::move(member), std::move(title),
          [get](const Row& row) { return nlohmann::ordered_json(std::invoke(get, row)); },
          [get](const Row& row) { return Cell(std::invoke(get, row)); }, Align::left};
}

template <typename Row, typename Get>
[[nodiscard]] Measure<Row> count_of(std::string member, std::string title, Get get) {
  return {std::move(member), std::move(title),
          [get](const Row& row) { return nlohmann::ordered_json(std::invoke(get, row)); },
          [get](const Row& row) { return Cell(std::to_string(std::invoke(get, row))); }};
}

/// \param written  how a table has an optional number: share_figure, decimals(2)
template <typename Row, typename Written, typename Get>
[[nodiscard]] Measure<Row> number_of(std::string member, std::string title, Written written,
                                     Get get) {
  return {std::move(member), std::move(title),
          [get](const Row& row) { return figure_json(std::invoke(get, row)); },
          [get, written](const Row& row) { return Cell(written(std::invoke(get, row))); }};
}

/// \param written  how a table has an optional interval: share_range, range_decimals(2)
template <typename Row, typename Written, typename Get>
[[nodiscard]] Measure<Row> interval_of(std::string member, std::string title, Written written,
                                       Get get) {
  return {std::move(member), std::move(title),
          [get](const Row& row) {
            return interval_json(std::optional<Interval>(std::invoke(get, row)));
          },
          [get, written](const Row& row) {
            return Cell(written(std::optional<Interval>(std::invoke(get, row))));
          }};
}

/// A column that no file has, of numbers that stand in it by themselves.
template <typename Row, typename Get>
[[nodiscard]] Measure<Row> shown_of(std::string title, Get get) {
  return {"", std::move(title), {}, [get](const Row& row) { return Cell(std::invoke(get, row)); }};
}

/// A member that no table has.
template <typename Row, typename Get>
[[nodiscard]] Measure<Row> kept_of(std::string member, Get get) {
  return {std::move(member),
          "",
          [get](const Row& row) { return nlohmann::ordered_json(std::invoke(get, row)); },
          {}};
}

/// \}

/// Writes numbers with so many decimals, and a sign only if they are negative.
[[nodiscard]] inline auto decimals(int digits) {
  return [digits](std::optional<double> number) { return plain_figure(number, digits); };
}
[[nodiscard]] inline auto signed_decimals(int digits) {
  return [digits](std::optional<double> number) { return signed_plain_figure(number, digits); };
}
[[nodiscard]] inline auto range_decimals(int digits) {
  return [digits](const std::optional<Interval>& range) { return plain_range(range, digits); };
}

/// Participants, mean, Student's interval and standard deviation.
/// \param get  the MeanEstimate of a row
template <typename Row, typename Get>
void add_mean(int digits, Get get, MeasureList<Row>& all) {
  all.push_back(count_of<Row>(
      "participants", "n", [get](const Row& row) { return std::invoke(get, row).participants; }));
  all.push_back(number_of<Row>("mean", "mean", decimals(digits),
                               [get](const Row& row) { return std::invoke(get, row).mean; }));
  all.push_back(
      interval_of<Row>("interval", "t 95%", range_decimals(digits),
                       [get](const Row& row) { return std::invoke(get, row).known_interval(); }));
  all.push_back(number_of<Row>("sd", "SD", decimals(digits),
                               [get](const Row& row) { return std::invoke(get, row).sd; }));
}

/// The members of one row.
template <typename Row>
[[nodiscard]] nlohmann::ordered_json object_of(const Row& row, const MeasureList<Row>& measures) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const Measure<Row>& one : measures) {
    if (!one.member.empty()) object[one.member] = one.json(row);
  }
  return object;
}

template <typename Row>
[[nodiscard]] nlohmann::ordered_json objects_of(const std::vector<Row>& rows,
                                                const MeasureList<Row>& measures) {
  return array_json(rows, [&](const Row& row) { return object_of(row, measures); });
}

/// Fills a table without columns: one for each measure that has a title, one row for each row, and
/// the measures' notes.
template <typename Row>
[[nodiscard]] Table table_of(std::string id, std::string caption, const std::vector<Row>& rows,
                             const MeasureList<Row>& measures) {
  Table table{std::move(id), std::move(caption), {}};
  table.rows.resize(rows.size());
  for (const Measure<Row>& one : measures) {
    if (one.title.empty()) continue;
    std::vector<Cell> cells;
    for (const Row& row : rows) cells.push_back(one.cell(row));
    const auto is_unknown = [](const Cell& cell) { return cell.text == kNoFigure; };
    if (one.only_known && std::ranges::all_of(cells, is_unknown)) continue;
    table.columns.push_back({one.title, table.columns.empty() ? Align::left : one.align});
    for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(std::move(cells[i]));
    table.notes.insert(table.notes.end(), one.notes.begin(), one.notes.end());
  }
  return table;
}

}  // namespace touchtrial::analysis
