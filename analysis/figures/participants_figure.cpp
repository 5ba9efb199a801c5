#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/style.hpp"
#include "analysis/text_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Taller heaps are drawn as bars: dots would be smaller than a printed line.
constexpr int kDotsOfHeap = 24;
constexpr int kFinestSteps = 50;  ///< an accuracy's places, where there are more trials than these
constexpr double kRow_cm = 3.0;

/// Accuracies sorted into places, with how many participants each has.
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

/// x, y, and for bars their lower edge.
std::vector<std::vector<double>> marks_of(const Heaps& heaps, double base, bool bars) {
  std::vector<std::vector<double>> rows;
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
  std::vector<std::vector<double>> means;
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

  Figure figure{
      .id = "participants", .caption = {}, .alt = alt_of_participants(report), .script = {}};
  figure.width_cm = sheet.width_cm;
  figure.height_cm = sheet.height_cm;
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

}  // namespace touchtrial::analysis
