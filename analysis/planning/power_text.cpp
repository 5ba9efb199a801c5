#include "analysis/planning/power_words.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

std::string power_table(const PowerReport& report) {
  analysis::TextTable table({"participants", "runs", "power %", "MC interval", "type-I %", "MC 95%",
                             "attainable %", "error"});
  for (const PowerRow& row : report.rows) {
    table.add({std::to_string(row.participants),
               std::to_string(row.significant.n) + (row.stopped_early ? " (stopped)" : ""),
               power_per_cent(row.significant.share().value_or(0.0)), power_range(row.power),
               power_per_cent(row.false_alarms.share().value_or(0.0)), power_range(row.type_one),
               power_per_cent(row.attainable), std::string(name_of(verdict_of(row)))});
  }
  return table.text();
}

std::string width_table(const PowerReport& report) {
  const bool compares = report.setting.protocol == "comparison";
  analysis::TextTable table({"participants", compares ? "difference" : "accuracy", "SD of studies",
                             "width", "MC error", "10%", "median", "90%"});
  for (const PowerRow& row : report.rows) {
    const WidthFigures& width = row.width;
    table.add({std::to_string(row.participants), power_per_cent(row.estimate),
               power_per_cent(row.estimate_sd), power_per_cent(width.mean),
               fmt::format("{:.2f}", 100.0 * width.standard_error), power_per_cent(width.lower),
               power_per_cent(width.median), power_per_cent(width.upper)});
  }
  return table.text();
}

}  // namespace

std::string power_text(const PowerReport& report) {
  std::string text = std::string(kPowerStamp) + "\n";
  text += analysis::wrapped("study    ", report.setting.study + ", " + report.setting.protocol);
  text += analysis::wrapped("test     ", report.setting.test);
  text += analysis::wrapped("assumed  ", report.setting.subject);
  text +=
      analysis::heading("Power and type-I error of the primary test", true) + power_table(report);
  text += analysis::heading(
              "Estimate, and width of its 95 % interval: mean, and quantiles over studies (points)",
              true) +
          width_table(report) + "\n";
  for (const std::string& sentence : target_sentences(report))
    text += analysis::wrapped("", sentence);
  for (const std::string& warning : report.warnings) text += analysis::wrapped("! ", warning);
  text += "\n";
  for (const std::string& sentence : method_sentences(report))
    text += analysis::wrapped("", sentence);
  return text + kPowerStamp + "\n";
}

}  // namespace touchtrial::planning
