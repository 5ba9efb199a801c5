#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/panels.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Fewer trials than this at a place, and places are put together: an interval over a handful is as
/// wide as the panel.
constexpr int kTrialsOfPoint = 15;
/// No more points than can be told apart.
constexpr int kMostPositions = 60;

struct Point {
  double first = 0.0;
  double last = 0.0;
  Proportion accuracy;
};

double place_of(const std::string& group) {
  int place = 0;
  std::from_chars(group.data(), group.data() + group.size(), place);
  return place;
}

const Breakdown* by_trial(const MethodReport& method) {
  for (const Breakdown& breakdown : method.breakdowns) {
    if (breakdown.kind == BreakdownKind::trial) return &breakdown;
  }
  return nullptr;
}

/// How many places make a point.
int places_together(const std::vector<GroupAccuracy>& groups) {
  int trials = 0;
  for (const GroupAccuracy& group : groups) trials += group.accuracy.n;
  const auto places = static_cast<int>(groups.size());
  const double of_place = static_cast<double>(trials) / std::max(places, 1);
  const int needed = static_cast<int>(std::ceil(kTrialsOfPoint / std::max(of_place, 1.0)));
  return std::max({1, needed, (places + kMostPositions - 1) / kMostPositions});
}

std::vector<Point> points_of(const std::vector<GroupAccuracy>& groups) {
  const int together = places_together(groups);
  std::vector<Point> points;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double place = place_of(groups[i].group);
    if (i % static_cast<std::size_t>(together) == 0) points.push_back({place, place, {}});
    points.back().last = place;
    points.back().accuracy.n += groups[i].accuracy.n;
    points.back().accuracy.correct += groups[i].accuracy.correct;
  }
  return points;
}

std::vector<std::vector<double>> rows_of(const std::vector<Point>& points) {
  std::vector<std::vector<double>> rows;
  for (const Point& point : points) {
    const std::optional<double> share = point.accuracy.share();
    if (!share) continue;
    const Interval wilson = wilson_interval(point.accuracy);
    rows.push_back({0.5 * (point.first + point.last), 100.0 * *share, 100.0 * wilson.low,
                    100.0 * wilson.high});
  }
  return rows;
}

std::string plot_of_trials(std::size_t number) {
  return fmt::format(
      "plot $trials{0} using 1:3:4 with filledcurves fs solid 0.2 noborder lc rgb '{1}' notitle, "
      "$trials{0} using 1:2 with linespoints pt {2} ps 0.5 lw 1.3 lc rgb '{1}' notitle",
      number, series_colour(number), series_mark(number));
}

}  // namespace

std::optional<Figure> trials_figure(const StudyReport& report) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const Breakdown* breakdown = by_trial(report.methods[i]);
    if (breakdown != nullptr && !breakdown->groups.empty()) shown.push_back(i);
  }
  if (shown.empty()) return {};
  const auto classes = static_cast<int>(report.classes.size());
  const Panels panels(shown.size(), 2, 6.0, {1.5, 0.4, 0.6, 1.25}, report.simulated);
  Figure figure{.id = "accuracy-over-trials",
                .caption = {},
                .alt =
                    "Accuracy by place among a "
                    "participant's trials.",
                .script = sheet_head(panels.sheet()) + "set multiplot\n"};
  const Legend legend(
      panels.sheet(), 1.5,
      std::vector<LegendEntry>{{LegendEntry::Kind::field, "#4d4d4d", 7, "95 % Wilson interval"},
                               chance_entry(classes)});
  int most = 1;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const MethodReport& method = report.methods[shown[i]];
    const std::vector<GroupAccuracy>& groups = by_trial(method)->groups;
    const std::vector<Point> points = points_of(groups);
    const std::vector<std::vector<double>> rows = rows_of(points);
    most = std::max(most, places_together(groups));
    if (rows.empty()) continue;
    figure.script += data_block(fmt::format("trials{}", i), rows) + panels.begin(i, method.method) +
                     accuracy_axis("correct, %") + "set xlabel 'trial' offset 0, 0.4\n" +
                     fmt::format("set xrange [{}:{}]\n", place_of(groups.front().group) - 1.0,
                                 place_of(groups.back().group) + 1.0) +
                     chance_line(classes);

    figure.script += (i == 0 ? legend.script() : "") + plot_of_trials(i) + "\n";
    figure.script += "unset label\nunset arrow\nunset object\n";
    figure.alt += fmt::format(" {}: {:.1f} % at first, {:.1f} % at last.", method.method,
                              rows.front()[1], rows.back()[1]);
  }
  figure.script += "unset multiplot\n";
  figure.width_cm = panels.sheet().width_cm;
  figure.height_cm = panels.sheet().height_cm;
  figure.caption = stamped(
      report.simulated,
      "accuracy by place among a participant's trials of the method, all participants pooled" +
          (most > 1 ? fmt::format(", up to {} places together", most) : std::string()) +
          ". Bands are 95 % Wilson intervals.");
  return figure;
}

}  // namespace touchtrial::analysis
