/// \file Numbers of a report, each described once: its member of results.json, its column in a table
/// and in a CSV file, and its notes. Lists of them make tables, JSON objects and CSV files. All
/// functions are thread-safe.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/report/json_figures.hpp"
#include "analysis/report/page/document.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/prevalence.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// A number that each `Row` has.
template <typename Row>
struct Measure {
  std::string member;  ///< of results.json; empty: only in tables
  std::string title;   ///< of the column; empty: only in results.json
  std::function<nlohmann::ordered_json(const Row&)> json;
  std::function<Cell(const Row&)> cell;
  Align align = Align::right;
  std::vector<CitedText> notes{};  ///< below a table with the column
  bool hide_if_unknown = false;    ///< omit the column if no row has the number
  /// Columns of a CSV file: one for a number, one for each part of an interval or object; an empty
  /// name omits the part.
  std::vector<std::string> columns{};
  std::vector<std::string> inner_members{};  ///< if the member is an object

  [[nodiscard]] Measure with_note(std::string text, std::vector<Source> sources = {}) && {
    notes.push_back({std::move(text), std::move(sources)});
    return std::move(*this);
  }
  [[nodiscard]] Measure hidden_if_unknown() && {
    hide_if_unknown = true;
    return std::move(*this);
  }
  [[nodiscard]] Measure with_cells(std::string heading, std::function<Cell(const Row&)> format) && {
    title = std::move(heading);
    cell = std::move(format);
    return std::move(*this);
  }
  [[nodiscard]] Measure in_csv(std::vector<std::string> names) && {
    columns = std::move(names);
    return std::move(*this);
  }
};

template <typename Row>
using MeasureList = std::vector<Measure<Row>>;

template <typename Row>
[[nodiscard]] MeasureList<Row> joined_measures(std::vector<MeasureList<Row>> lists) {
  MeasureList<Row> all;
  for (MeasureList<Row>& list : lists) std::ranges::move(list, std::back_inserter(all));
  return all;
}

/// Gives members a column in tables.
/// \param titles  by member
template <typename Row>
[[nodiscard]] MeasureList<Row> titled(
    MeasureList<Row> list, const std::vector<std::pair<std::string, std::string>>& titles) {
  for (const auto& [member, title] : titles) {
    std::ranges::find(list, member, &Measure<Row>::member)->title = title;
  }
  return list;
}

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

/// \param format  of the cells: share_figure, decimals(2)
template <typename Row, typename Format, typename Get>
[[nodiscard]] Measure<Row> number_of(std::string member, std::string title, Format format,
                                     Get get) {
  return {std::move(member), std::move(title),
          [get](const Row& row) { return figure_json(std::invoke(get, row)); },
          [get, format](const Row& row) { return Cell(format(std::invoke(get, row))); }};
}

/// \param format  of the cells: share_range, range_decimals(2)
template <typename Row, typename Format, typename Get>
[[nodiscard]] Measure<Row> interval_of(std::string member, std::string title, Format format,
                                       Get get) {
  return {std::move(member), std::move(title),
          [get](const Row& row) {
            return interval_json(std::optional<Interval>(std::invoke(get, row)));
          },
          [get, format](const Row& row) {
            return Cell(format(std::optional<Interval>(std::invoke(get, row))));
          }};
}

/// A column that is not in results.json.
template <typename Row, typename Get>
[[nodiscard]] Measure<Row> column_of(std::string title, Get get) {
  return {"", std::move(title), {}, [get](const Row& row) { return Cell(std::invoke(get, row)); }};
}

/// A member without a column.
template <typename Row, typename Get>
[[nodiscard]] Measure<Row> member_of(std::string member, Get get) {
  return {std::move(member),
          "",
          [get](const Row& row) { return nlohmann::ordered_json(std::invoke(get, row)); },
          {}};
}

/// A number without a column.
template <typename Row, typename Get>
[[nodiscard]] Measure<Row> number_member(std::string member, Get get) {
  return member_of<Row>(std::move(member),
                        [get](const Row& row) { return figure_json(std::invoke(get, row)); });
}

/// \}

/// \name Measures of a part of a row. `get` takes a row and returns the part, an optional part or a
/// pointer; the numbers of a missing part are unknown.
/// \{

/// \return null if the part is missing
template <typename Part, typename Value>
[[nodiscard]] const Part* part_in(const Value& value) {
  if constexpr (std::is_same_v<Part, Value>) {
    return &value;
  } else {
    return value ? &*value : nullptr;
  }
}

/// The measures of a part as measures of the row.
template <typename Row, typename Part, typename Get>
[[nodiscard]] MeasureList<Row> measures_in(Get get, const MeasureList<Part>& part_measures) {
  MeasureList<Row> all;
  for (const Measure<Part>& measure : part_measures) {
    Measure<Row> outer{measure.member,
                       measure.title,
                       {},
                       {},
                       measure.align,
                       measure.notes,
                       measure.hide_if_unknown,
                       measure.columns,
                       measure.inner_members};
    const auto row_function = [get](auto part_function, auto missing) {
      return [get, part_function, missing](const Row& row) -> decltype(missing) {
        const auto& value = std::invoke(get, row);
        const Part* part = part_in<Part, std::remove_cvref_t<decltype(value)>>(value);
        return part == nullptr ? missing : part_function(*part);
      };
    };
    if (measure.json) outer.json = row_function(measure.json, nlohmann::ordered_json());
    if (measure.cell) outer.cell = row_function(measure.cell, Cell(kNoFigure));
    all.push_back(std::move(outer));
  }
  return all;
}

/// \}

/// \name Formats of cells
/// \{
[[nodiscard]] inline auto decimals(int digits) {
  return [digits](std::optional<double> number) { return plain_figure(number, digits); };
}
[[nodiscard]] inline auto signed_decimals(int digits) {
  return [digits](std::optional<double> number) { return signed_plain_figure(number, digits); };
}
[[nodiscard]] inline auto range_decimals(int digits) {
  return [digits](const std::optional<Interval>& range) { return plain_range(range, digits); };
}
/// \}

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

/// The JSON object of one row.
template <typename Row>
[[nodiscard]] nlohmann::ordered_json object_of(const Row& row, const MeasureList<Row>& measures) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const Measure<Row>& measure : measures) {
    if (!measure.member.empty()) object[measure.member] = measure.json(row);
  }
  return object;
}

template <typename Row>
[[nodiscard]] nlohmann::ordered_json objects_of(const std::vector<Row>& rows,
                                                const MeasureList<Row>& measures) {
  return array_json(rows, [&](const Row& row) { return object_of(row, measures); });
}

/// The names of the members; nested ones are "outer.inner".
template <typename Row>
[[nodiscard]] std::vector<std::string> members_of(const MeasureList<Row>& measures) {
  std::vector<std::string> all;
  for (const Measure<Row>& measure : measures) {
    if (measure.member.empty()) continue;
    all.push_back(measure.member);
    for (const std::string& inner : measure.inner_members)
      all.push_back(measure.member + "." + inner);
  }
  return all;
}

/// A member that is an object, with the measures of a part of the row; null if the part is missing.
template <typename Row, typename Part, typename Get>
[[nodiscard]] Measure<Row> object_in(std::string member, Get get, MeasureList<Part> part_measures) {
  std::vector<std::string> inner_members = members_of(part_measures);
  Measure<Row> object = member_of<Row>(
      std::move(member),
      [get, part_measures = std::move(part_measures)](const Row& row) -> nlohmann::ordered_json {
        const auto& value = std::invoke(get, row);
        const Part* part = part_in<Part, std::remove_cvref_t<decltype(value)>>(value);
        return part == nullptr ? nlohmann::ordered_json() : object_of(*part, part_measures);
      });
  object.inner_members = std::move(inner_members);
  return object;
}

/// A part as an object in results.json, with its measures as columns of a table.
template <typename Row, typename Part, typename Get>
[[nodiscard]] MeasureList<Row> part_of(std::string member, Get get,
                                       const MeasureList<Part>& part_measures) {
  MeasureList<Row> all = measures_in<Row>(get, part_measures);
  for (Measure<Row>& measure : all) measure.member.clear();
  all.push_back(object_in<Row>(std::move(member), get, part_measures));
  return all;
}

/// The CSV cell of a number or text of results.json.
[[nodiscard]] DataCell data_cell(const nlohmann::ordered_json& value);

/// The table of a CSV file: the CSV columns of all measures.
template <typename Row>
[[nodiscard]] DataTable data_table_of(const std::vector<Row>& rows,
                                      const MeasureList<Row>& measures) {
  DataTable table;
  table.rows.resize(rows.size());
  for (const Measure<Row>& measure : measures) {
    std::ranges::copy_if(measure.columns, std::back_inserter(table.columns),
                         [](const std::string& name) { return !name.empty(); });
    for (std::size_t i = 0; i < rows.size() && !measure.columns.empty(); ++i) {
      const nlohmann::ordered_json value = measure.json(rows[i]);
      auto part = value.begin();
      for (const std::string& name : measure.columns) {
        if (!name.empty()) {
          table.rows[i].push_back(data_cell(value.is_structured() ? *part : value));
        }
        if (value.is_structured()) ++part;
      }
    }
  }
  return table;
}

/// A table with one column per measure that has a title, one line per element of `rows`, and the
/// measures' notes.
template <typename Row>
[[nodiscard]] Table table_of(std::string id, std::string caption, const std::vector<Row>& rows,
                             const MeasureList<Row>& measures) {
  Table table{std::move(id), std::move(caption), {}};
  table.rows.resize(rows.size());
  for (const Measure<Row>& measure : measures) {
    if (measure.title.empty()) continue;
    std::vector<Cell> cells;
    for (const Row& row : rows) cells.push_back(measure.cell(row));
    const auto is_unknown = [](const Cell& cell) { return cell.text == kNoFigure; };
    if (measure.hide_if_unknown && std::ranges::all_of(cells, is_unknown)) continue;
    table.columns.push_back({measure.title, table.columns.empty() ? Align::left : measure.align});
    for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(std::move(cells[i]));
    table.notes.insert(table.notes.end(), measure.notes.begin(), measure.notes.end());
  }
  return table;
}

[[nodiscard]] MeasureList<Prevalence> prevalence_measures();

}  // namespace touchtrial::analysis
