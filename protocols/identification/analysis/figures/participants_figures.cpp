#include "analysis/report/figures/style.hpp"
#include "analysis/report/text_table.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

/// Taller heaps are drawn as bars, because their dots would be too small to print.
constexpr int kDotsOfHeap = 24;
constexpr int kFinestSteps = 50;  ///< the most places on the axis of accuracy
constexpr double kRow_cm = 3.0;

/// Accuracies sorted into places, with the number of participants at each place.
struct Heaps {
  double step = 4.0;  ///< between places, per cent
  std::map<int, int> counts;
  int highest = 1;
};

Heaps heaps_of(const MethodReport& method) {
  int trials = 1;
  for (const ParticipantAccuracy& one : method.per_participant) {
    trials = std::max(trials, one.accuracy.n);
  }
  Heaps heaps;
  const int places = std::min(trials, kFinestSteps);
  heaps.step = 100.0 / places;
  for (const ParticipantAccuracy& one : method.per_participant) {
    const std::optional<double> share = one.accuracy.share();
    if (!share) continue;
    int& count = heaps.counts[static_cast<int>(std::lround(*share * places))];
    heaps.highest = std::max(heaps.highest, ++count);
  }
  return heaps;
}

/// Rows of x and y; for bars, also of their lower edge.
Rows marks_of(const Heaps& heaps, double base, bool bars) {
  Rows rows;
  const double height = 0.62 / std::max(heaps.highest, 8);
  for (const auto& [place, count] : heaps.counts) {
    const double x = heaps.step * place;
    if (bars) {
      rows.push_back({x, base + height * count, base});
      continue;
    }
    for (int i = 0; i < count; ++i) rows.push_back({x, base + height * (i + 0.6)});
  }
  return rows;
}

std::string dots_plot(std::size_t number, const Heaps& heaps) {
  const double size = std::clamp(5.0 / std::max(heaps.highest, 8), 0.25, 0.6);
  return fmt::format("$heap{} using 1:2 with points pt {} ps {:.2f} lc rgb '{}' notitle", number,
                     series_mark(number), size, series_colour(number));
}

std::string bars_plot(std::size_t number, const Heaps& heaps) {
  return fmt::format(
      "$heap{0} using 1:2:($1 - {1:.4g}):($1 + {1:.4g}):3:2 with boxxyerror fs solid 0.55 noborder "
      "lc rgb '{2}' notitle",
      number, 0.42 * heaps.step, series_colour(number));
}

std::string alt_of_participants(const StudyReport& report) {
  std::string alt = "Each participant's accuracy as a dot, the mean and its 95 % interval.";
  for (const MethodReport& method : report.methods) {
    if (!method.mean.mean) continue;
    alt += fmt::format(" {}: {} participants, mean {}.", method.method, method.mean.participants,
                       with_interval(*method.mean.mean, method.mean.known_interval()));
  }
  return alt;
}

/// The least number of trials of a point. Places with fewer trials are joined, because their
/// interval would be as wide as the panel.
constexpr int kTrialsOfPoint = 15;
/// The most points that readers can tell apart.
constexpr int kMaxPositions = 60;

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

/// The number of places that are joined into one point.
int places_together(const std::vector<GroupAccuracy>& groups) {
  int trials = 0;
  for (const GroupAccuracy& group : groups) trials += group.accuracy.n;
  const auto places = static_cast<int>(groups.size());
  const double of_place = static_cast<double>(trials) / std::max(places, 1);
  const int needed = static_cast<int>(std::ceil(kTrialsOfPoint / std::max(of_place, 1.0)));
  return std::max({1, needed, (places + kMaxPositions - 1) / kMaxPositions});
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

Rows rows_of(const std::vector<Point>& points) {
  Rows rows;
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

/// Rows of the place of the class and the time in seconds.
Rows points_of(const std::vector<ReactionTimes>& times, std::size_t classes) {
  Rows points;
  for (std::size_t i = 0; i < classes; ++i) {
    add_dots(points, static_cast<double>(i + 1), 0.56, times[i].seconds);
  }
  return points;
}

Rows boxes_of(const std::vector<ReactionTimes>& times, std::size_t classes) {
  Rows boxes;
  for (std::size_t i = 0; i < classes; ++i) {
    const Quartiles& q = times[i].from_plane_on;
    if (q.median) boxes.push_back({static_cast<double>(i + 1), *q.lower, *q.median, *q.upper});
  }
  return boxes;
}

bool has_times(const MethodReport& method, std::size_t classes) {
  return method.reaction.size() >= classes &&
         std::any_of(
             method.reaction.begin(),
             method.reaction.begin() + static_cast<std::ptrdiff_t>(classes),
             [](const ReactionTimes& times) { return times.from_plane_on.median.has_value(); });
}

std::string plot_of_reactions(std::size_t number) {
  return fmt::format(
      "plot $times{0} using 1:2 with points pt {1} ps 0.22 lc rgb '{3}' notitle, $boxes{0} using "
      "1:3:($1 - 0.34):($1 + 0.34):2:4 with boxxyerror fs empty border lc rgb '{2}' lw 1.5 lc rgb "
      "'{2}' notitle, $boxes{0} using ($1 - 0.34):3:(0.68):(0) with vectors nohead lw 3 lc rgb "
      "'{2}' notitle",
      number, 7, series_colour(number), kFaint);
}

std::string alt_of_reactions(const StudyReport& report, const MethodReport& method) {
  std::string alt;
  for (std::size_t i = 0; i < report.classes.size(); ++i) {
    const Quartiles& q = method.reaction[i].from_plane_on;
    if (!q.median) continue;
    alt += fmt::format(" {}, {}: {:.2f} s ({:.2f} to {:.2f});", method.method, report.classes[i],
                       *q.median, *q.lower, *q.upper);
  }
  return alt;
}

}  // namespace

std::optional<Figure> participants_figure(const StudyReport& report) {
  const auto rows = static_cast<int>(report.methods.size());
  const bool any = std::any_of(report.methods.begin(), report.methods.end(),
                               [](const MethodReport& m) { return m.mean.mean.has_value(); });
  if (!any) return {};
  Sheet sheet{16.0, 2.2 + kRow_cm * std::min(rows, 6), report.simulated};
  Margins margins;
  margins.left_cm = 3.2;
  margins.bottom_cm = 1.25;
  const auto classes = static_cast<int>(report.classes.size());
  const Legend legend(
      sheet, margins.left_cm,
      std::vector<LegendEntry>{mark_entry(series_mark(0), series_colour(0), "participants"),
                               mark_entry(13, kInk, "mean, with 95 % t interval"),
                               chance_entry(classes)});
  margins.top_cm = legend.room_cm() + 0.2;
  std::string data;
  std::string names;
  std::string plot;
  Rows means;
  for (int i = 0; i < rows; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const MethodReport& method = report.methods[at];
    const double base = rows - 1 - i;
    const Heaps heaps = heaps_of(method);
    const bool bars = heaps.highest > kDotsOfHeap;
    names += text_at(fitted(method.method, 16),
                     fmt::format("graph 0, first {} right offset -1, 0", base + 0.25));
    if (!method.mean.mean) continue;
    data += data_block(fmt::format("heap{}", i), marks_of(heaps, base, bars));
    plot += (plot.empty() ? "plot " : ", ") + (bars ? bars_plot(at, heaps) : dots_plot(at, heaps));
    const double mean = *method.mean.mean;
    const Interval bar = method.mean.known_interval().value_or(Interval{mean, mean});
    means.push_back({100.0 * mean, base - 0.13, 100.0 * bar.low, 100.0 * bar.high});
  }

  Figure figure = figure_on(sheet, "participants", alt_of_participants(report), "accuracy");
  figure.caption = stamped(report.simulated,
                           "every participant's accuracy, and the mean over participants. The "
                           "interval is Student's t, at the level of participants.");
  figure.script =
      data + data_block("means", means) + sheet_head(sheet) + panel_at(sheet, margins) + names +
      fmt::format(
          "set border 1\nunset ytics\nunset grid\nset grid xtics lc rgb '#e0e0e0' lw 0.7\n"
          "set xrange [-2:102]\nset xtics 0, 20, 100\nset xlabel 'correct, %' offset 0, "
          "0.4\nset yrange [-0.3:{}]\n",
          rows - 0.25) +
      fmt::format(
          "set arrow from first {0:.6g}, graph 0 to first {0:.6g}, graph 1 nohead dt (6, "
          "5) lw 1.2 lc rgb '{1}' back\n",
          100.0 / std::max(classes, 1), kInk) +
      legend.script() + plot +
      fmt::format(", $means using 1:2:3:4 with xerrorbars pt 13 ps 1 lw 1.8 lc rgb '{}' notitle",
                  kInk) +
      "\n";
  return figure;
}

std::optional<Figure> trials_figure(const StudyReport& report) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const Breakdown* breakdown = by_trial(report.methods[i]);
    if (breakdown != nullptr && !breakdown->groups.empty()) shown.push_back(i);
  }
  if (shown.empty()) return {};
  const auto classes = static_cast<int>(report.classes.size());
  const Panels panels(shown.size(), 2, 6.0, {1.5, 0.4, 0.6, 1.25}, report.simulated);
  Figure figure = figure_on(panels.sheet(), "accuracy-over-trials",
                            "Accuracy by place among a participant's trials.", "order");
  figure.script = sheet_head(panels.sheet()) + "set multiplot\n";
  const Legend legend(
      panels.sheet(), 1.5,
      std::vector<LegendEntry>{{LegendEntry::Kind::field, "#4d4d4d", 7, "95 % Wilson interval"},
                               chance_entry(classes)});
  int most = 1;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const MethodReport& method = report.methods[shown[i]];
    const std::vector<GroupAccuracy>& groups = by_trial(method)->groups;
    const std::vector<Point> points = points_of(groups);
    const Rows rows = rows_of(points);
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
  figure.caption = stamped(
      report.simulated,
      "accuracy by place among a participant's trials of the method, all participants pooled" +
          (most > 1 ? fmt::format(", up to {} places together", most) : std::string()) +
          ". Bands are 95 % Wilson intervals, as if all trials were independent.");
  return figure;
}

std::optional<Figure> reaction_figure(const StudyReport& report) {
  const std::size_t classes = report.classes.size();
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (has_times(report.methods[i], classes)) shown.push_back(i);
  }
  if (shown.empty() || classes == 0) return {};
  const std::size_t across = classes > 6 ? 1 : 2;
  Margins around{1.5, 0.4, 0.6, 1.0};
  around.bottom_cm =
      NamesBelow(report.classes,
                 Panels(shown.size(), across, 6.0, around, report.simulated).axis_cm())
          .room_cm() +
      0.3;
  const Panels panels(shown.size(), across, 5.6 + around.bottom_cm, around, report.simulated);
  const NamesBelow below(report.classes, panels.axis_cm());
  Figure figure = figure_on(panels.sheet(), "reaction-times",
                            "Median reaction time and quartiles by class:", "reaction-times");
  figure.script = sheet_head(panels.sheet()) + "set multiplot\n";
  const Legend legend(
      panels.sheet(), 1.5,
      std::vector<LegendEntry>{mark_entry(7, kFaint, "trials"),
                               {LegendEntry::Kind::line, std::string(series_colour(0)), 7,
                                "median, in a box from quartile to quartile"}});
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const MethodReport& method = report.methods[shown[i]];
    figure.script += data_block(fmt::format("times{}", i), points_of(method.reaction, classes)) +
                     data_block(fmt::format("boxes{}", i), boxes_of(method.reaction, classes)) +
                     panels.begin(i, method.method) + below.script() +
                     "set yrange [0:*]\nset ytics auto format '%g'\nset ylabel 'reaction time, "
                     "s'\n";
    figure.script += (i == 0 ? legend.script() : "") + plot_of_reactions(i) + "\n";
    figure.script += "unset label\nunset arrow\n";
    figure.alt += alt_of_reactions(report, method);
  }
  figure.script += "unset multiplot\n";
  figure.caption = stamped(
      report.simulated,
      fmt::format("reaction times by presented class, from plane-on to the answer, all "
                  "participants' trials with a response. At most {} trials a class are drawn, "
                  "evenly over their order.",
                  kMaxDots));
  return figure;
}

}  // namespace touchtrial::analysis::identification
