/// \file Numbers of a report, each described once: the member of results.json, the title and the
/// cells of a table's column, the columns of a CSV file, and the note that says what it is. Tables,
/// JSON objects and CSV files are made of lists of them. All functions are thread-safe.
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
  /// Columns of a CSV file: one for a number, one for each end or member of an interval or object;
  /// an empty name leaves that part out.
  std::vector<std::string> columns{};
  std::vector<std::string> within{};  ///< members of a member that is an object

  /// The same number with a note.
  [[nodiscard]] Measure with(std::string text, std::vector<Source> sources = {}) && {
    notes.push_back({std::move(text), std::move(sources)});
    return std::move(*this);
  }
  [[nodiscard]] Measure if_known() && {
    only_known = true;
    return std::move(*this);
  }
  /// The same number with cells of its own.
  [[nodiscard]] Measure shown(std::string heading, std::function<Cell(const Row&)> written) && {
    title = std::move(heading);
    cell = std::move(written);
    return std::move(*this);
  }
  [[nodiscard]] Measure in_csv(std::vector<std::string> names) && {
    columns = std::move(names);
    return std::move(*this);
  }
};

template <typename Row>
using MeasureList = std::vector<Measure<Row>>;

/// The lists one after the other.
template <typename Row>
[[nodiscard]] MeasureList<Row> joined_measures(std::vector<MeasureList<Row>> lists) {
  MeasureList<Row> all;
  for (MeasureList<Row>& one : lists) std::ranges::move(one, std::back_inserter(all));
  return all;
}

/// The list with columns for members that had none.
/// \param titles  of the columns, by member
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

/// A column without a member of results.json.
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

/// \name Measures of a part of a row. `get` takes a row and gives the part, an optional one, or a
/// pointer to it; of a part that does not exist every number is unknown.
/// \{

/// The part, or null.
template <typename Part, typename Got>
[[nodiscard]] const Part* part_in(const Got& got) {
  if constexpr (std::is_same_v<Part, Got>) {
    return &got;
  } else {
    return got ? &*got : nullptr;
  }
}

/// The measures of a part as those of the row.
template <typename Row, typename Part, typename Get>
[[nodiscard]] MeasureList<Row> measures_in(Get get, const MeasureList<Part>& of_part) {
  MeasureList<Row> all;
  for (const Measure<Part>& one : of_part) {
    Measure<Row> outer{one.member, one.title,      {},          {},        one.align,
                       one.notes,  one.only_known, one.columns, one.within};
    const auto of = [get](auto written, auto missing) {
      return [get, written, missing](const Row& row) -> decltype(missing) {
        const auto& got = std::invoke(get, row);
        const Part* part = part_in<Part, std::remove_cvref_t<decltype(got)>>(got);
        return part == nullptr ? missing : written(*part);
      };
    };
    if (one.json) outer.json = of(one.json, nlohmann::ordered_json());
    if (one.cell) outer.cell = of(one.cell, Cell(kNoFigure));
    all.push_back(std::move(outer));
  }
  return all;
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

/// The names of the members; of members of an object "outer.inner".
template <typename Row>
[[nodiscard]] std::vector<std::string> members_of(const MeasureList<Row>& measures) {
  std::vector<std::string> all;
  for (const Measure<Row>& one : measures) {
    if (one.member.empty()) continue;
    all.push_back(one.member);
    for (const std::string& inner : one.within) all.push_back(one.member + "." + inner);
  }
  return all;
}

/// One member that is an object: the measures of a part of the row; null without the part.
template <typename Row, typename Part, typename Get>
[[nodiscard]] Measure<Row> object_in(std::string member, Get get, MeasureList<Part> of_part) {
  std::vector<std::string> within = members_of(of_part);
  Measure<Row> object = member_of<Row>(
      std::move(member),
      [get, of_part = std::move(of_part)](const Row& row) -> nlohmann::ordered_json {
        const auto& got = std::invoke(get, row);
        const Part* part = part_in<Part, std::remove_cvref_t<decltype(got)>>(got);
        return part == nullptr ? nlohmann::ordered_json() : object_of(*part, of_part);
      });
  object.within = std::move(within);
  return object;
}

/// The part as one member of results.json, and its measures as columns of a table.
template <typename Row, typename Part, typename Get>
[[nodiscard]] MeasureList<Row> part_of(std::string member, Get get,
                                       const MeasureList<Part>& of_part) {
  MeasureList<Row> all = measures_in<Row>(get, of_part);
  for (Measure<Row>& one : all) one.member.clear();
  all.push_back(object_in<Row>(std::move(member), get, of_part));
  return all;
}

/// The cell of a CSV file with a number or text of results.json.
[[nodiscard]] DataCell data_cell(const nlohmann::ordered_json& value);

/// A CSV file's table: the columns of the measures that have some, in their order.
template <typename Row>
[[nodiscard]] DataTable data_table_of(const std::vector<Row>& rows,
                                      const MeasureList<Row>& measures) {
  DataTable table;
  table.rows.resize(rows.size());
  for (const Measure<Row>& one : measures) {
    std::ranges::copy_if(one.columns, std::back_inserter(table.columns),
                         [](const std::string& name) { return !name.empty(); });
    for (std::size_t i = 0; i < rows.size() && !one.columns.empty(); ++i) {
      const nlohmann::ordered_json value = one.json(rows[i]);
      auto part = value.begin();
      for (const std::string& name : one.columns) {
        const bool is_whole = !value.is_structured();
        if (!name.empty()) table.rows[i].push_back(data_cell(is_whole ? value : *part));
        if (!is_whole) ++part;
      }
    }
  }
  return table;
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

/// The share of people who would pass their own test.
[[nodiscard]] MeasureList<Prevalence> prevalence_measures();

}  // namespace touchtrial::analysis
