#include "analysis/exports/data_table.hpp"
#include "analysis/page/renderings.hpp"
#include "analysis/planning/power_words.hpp"

#include <cstdint>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

std::vector<analysis::DataCell> csv_row(const PowerRow& row) {
  return {std::int64_t{row.participants},
          std::int64_t{row.significant.n},
          std::int64_t{row.stopped_early ? 1 : 0},
          row.significant.share().value_or(0.0),
          row.power.low,
          row.power.high,
          std::int64_t{row.false_alarms.n},
          row.false_alarms.share().value_or(0.0),
          row.type_one.low,
          row.type_one.high,
          row.attainable,
          row.estimate,
          row.estimate_sd,
          row.width.mean,
          row.width.standard_error,
          row.width.lower,
          row.width.median,
          row.width.upper,
          std::string("SIMULATED")};
}

std::vector<analysis::Cell> table_row(const PowerRow& row) {
  return {std::to_string(row.participants),
          std::to_string(row.significant.n) + (row.stopped_early ? ", stopped" : ""),
          analysis::Cell(power_per_cent(row.significant.share().value_or(0.0)), true),
          power_range(row.power),
          power_per_cent(row.false_alarms.share().value_or(0.0)),
          power_range(row.type_one),
          power_per_cent(row.attainable),
          power_per_cent(row.estimate),
          power_per_cent(row.width.mean),
          power_range({row.width.lower, row.width.upper})};
}

analysis::Table table_of(const PowerReport& report) {
  analysis::Table table{"power",
                        "Power given the assumed sensitivity, type-I error and interval width: " +
                            report.setting.study + ", " + report.setting.test,
                        {{"participants"},
                         {"runs"},
                         {"power (%)"},
                         {"Monte-Carlo interval"},
                         {"type-I error (%)"},
                         {"Monte-Carlo 95%"},
                         {"attainable (%)"},
                         {report.setting.estimate + " (%)"},
                         {"interval width (points)"},
                         {"10 to 90% of studies"}}};
  for (const PowerRow& row : report.rows) table.rows.push_back(table_row(row));
  for (const std::string& sentence : target_sentences(report)) table.notes.push_back({sentence});
  for (const std::string& warning : report.warnings) table.notes.push_back({warning});
  table.notes.push_back({"Assumed: " + report.setting.subject + "."});
  for (const std::string& sentence : method_sentences(report)) table.notes.push_back({sentence});
  return table;
}

}  // namespace

std::string power_csv(const PowerReport& report) {
  analysis::DataTable table{
      {"participants", "runs", "stopped_early", "power", "power_low", "power_high", "null_runs",
       "type_one_error", "type_one_low", "type_one_high", "attainable", "estimate", "estimate_sd",
       "width_mean", "width_mean_se", "width_q10", "width_median", "width_q90", "stamp"},
      {}};
  for (const PowerRow& row : report.rows) table.rows.push_back(csv_row(row));
  return analysis::csv_text(table);
}

std::string power_markdown(const PowerReport& report) {
  return analysis::table_markdown(table_of(report), "SIMULATED");
}

}  // namespace touchtrial::planning
