#include "analysis/figures/style.hpp"
#include "analysis/planning/power_report.hpp"
#include "analysis/statistics/chance_test.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

constexpr double kHeight_cm = 6.2;

struct Axis {
  const char* title;
  const char* label;
  std::vector<std::vector<double>> rows;  ///< participants, value, low, high; per cent
  std::vector<double> lines;              ///< heights of dashed lines
  double top = 104.0;
  double step = 20.0;
};

std::string line_at(double height) {
  return fmt::format(
      "set arrow from graph 0, first {0:.6g} to graph 1, first {0:.6g} nohead dt (6, 5) lw 1.2 lc "
      "rgb '{1}' back\n",
      height, analysis::kInk);
}

/// Lets the axis run from 0 to a little above everything that is drawn.
void fit(Axis& axis) {
  double highest = 1.0;  // if all intervals have no width
  for (const auto& row : axis.rows) highest = std::max(highest, row[3]);
  for (const double line : axis.lines) highest = std::max(highest, line);
  for (const double step : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0}) {
    axis.step = step;
    if (highest <= 6.0 * step) break;
  }
  axis.top = 1.06 * highest;
}

Axis power_axis(const PowerReport& report) {
  Axis axis{"power", "significant studies, %", {}, {}, 104.0, 20.0};
  for (const PowerRow& row : report.rows) {
    axis.rows.push_back({1.0 * row.participants, 100.0 * row.estimated_power(),
                         100.0 * row.power.low, 100.0 * row.power.high});
  }
  for (const double target : kPowerTargets) axis.lines.push_back(100.0 * target);
  return axis;
}

Axis error_axis(const PowerReport& report) {
  Axis axis{"type-I error", "significant under the null, %", {}, {100.0 * report.plan.level}};
  for (const PowerRow& row : report.rows) {
    axis.rows.push_back({1.0 * row.participants, 100.0 * row.estimated_error(),
                         100.0 * row.type_one.low, 100.0 * row.type_one.high});
  }
  fit(axis);
  return axis;
}

Axis width_axis(const PowerReport& report) {
  Axis axis{"interval width", "width of the 95 % interval, points", {}, {}};
  for (const PowerRow& row : report.rows) {
    axis.rows.push_back({1.0 * row.participants, 100.0 * row.width.mean, 100.0 * row.width.lower,
                         100.0 * row.width.upper});
  }
  fit(axis);
  return axis;
}

std::string panel_script(const analysis::Panels& panels, std::size_t number, const Axis& axis) {
  const double first = axis.rows.front()[0];
  const double last = axis.rows.back()[0];
  const double room = std::max(1.0, 0.08 * (last - first));
  std::string script =
      analysis::data_block(fmt::format("power{}", number), axis.rows) +
      panels.begin(number, axis.title) +
      fmt::format("set yrange [0:{}]\nset ytics 0, {} format '%g'\n", axis.top, axis.step) +
      fmt::format("set ylabel '{}' noenhanced\n", axis.label) +
      "set xlabel 'participants' offset 0, 0.4\n" +
      fmt::format("set xrange [{}:{}]\nset xtics autofreq\n", first - room, last + room);
  for (const double line : axis.lines) script += line_at(line);
  return script +
         fmt::format(
             "plot $power{0} using 1:2 with lines lw 1.3 lc rgb '{1}' notitle, $power{0} using "
             "1:2:3:4 with yerrorbars pt {2} ps 0.6 lw 1.3 lc rgb '{1}' notitle\n",
             number, analysis::series_colour(number), analysis::series_mark(number)) +
         "unset label\nunset arrow\n";
}

std::string alt_of(const PowerReport& report) {
  std::string alt = "Power, type-I error and interval width against the number of participants.";
  for (const PowerRow& row : report.rows) {
    alt += fmt::format(
        " {} participants: power {} % {}, type-I error {} % {}, interval width {} points.",
        row.participants, power_per_cent(row.estimated_power()), power_range(row.power),
        power_per_cent(row.estimated_error()), power_range(row.type_one),
        power_per_cent(row.width.mean));
  }
  return alt;
}

}  // namespace

analysis::Figure power_figure(const PowerReport& report) {
  const std::vector<Axis> axes{power_axis(report), error_axis(report), width_axis(report)};
  const analysis::Panels panels(axes.size(), 3, kHeight_cm, {1.55, 0.15, 0.6, 1.25}, true);
  analysis::Figure figure{.id = "power", .caption = {}, .alt = alt_of(report), .script = {}};
  figure.caption = fmt::format(
      "{}. {}, {}. Left: share of significant studies, with its Monte-Carlo interval (Wilson, "
      "95 %); dashed: 80 and 90 %. Middle: the same under the null; dashed: the "
      "test's level. Right: width of the 95 % interval of the {}, mean over studies, and the "
      "range of the middle 80 % of studies.",
      power_stamp(report.setting), report.setting.study, report.setting.test,
      report.setting.estimate);
  figure.width_cm = panels.sheet().width_cm;
  figure.height_cm = panels.sheet().height_cm;
  figure.script = analysis::sheet_head(panels.sheet()) + "set multiplot\n";
  for (std::size_t i = 0; i < axes.size(); ++i) figure.script += panel_script(panels, i, axes[i]);
  figure.script += "unset multiplot\n";
  return figure;
}

}  // namespace touchtrial::planning
