#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/panels.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Trials shown a class; of more, evenly spaced ones in order of their times.
constexpr std::size_t kPointsOfClass = 100;
constexpr double kGoldenSection = 0.618033988749895;

/// Number of the class, and seconds; beside each other by a sequence that spreads evenly.
std::vector<std::vector<double>> points_of(const std::vector<ReactionTimes>& times,
                                           std::size_t classes) {
  std::vector<std::vector<double>> points;
  for (std::size_t i = 0; i < classes; ++i) {
    const std::vector<double>& seconds = times[i].seconds;
    const std::size_t shown = std::min(seconds.size(), kPointsOfClass);
    for (std::size_t k = 0; k < shown; ++k) {
      const std::size_t at = shown < 2 ? 0 : k * (seconds.size() - 1) / (shown - 1);
      const double aside = std::fmod(kGoldenSection * static_cast<double>(k), 1.0) - 0.5;
      points.push_back({static_cast<double>(i + 1) + 0.56 * aside, seconds[at]});
    }
  }
  return points;
}

std::vector<std::vector<double>> boxes_of(const std::vector<ReactionTimes>& times,
                                          std::size_t classes) {
  std::vector<std::vector<double>> boxes;
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
  Figure figure{.id = "reaction-times",
                .caption = {},
                .alt =
                    "Median reaction time and quartiles "
                    "by class:",
                .script = sheet_head(panels.sheet()) + "set multiplot\n"};
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
  figure.width_cm = panels.sheet().width_cm;
  figure.height_cm = panels.sheet().height_cm;
  figure.caption = stamped(
      report.simulated,
      fmt::format("reaction times by presented class, from plane-on to the answer, all "
                  "participants' trials with a response. At most {} trials a class are drawn, "
                  "evenly over their order.",
                  kPointsOfClass));
  return figure;
}

}  // namespace touchtrial::analysis
