#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/style.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Share of the sheet for participants' differences.
constexpr double kDifferences_cm = 6.0;
/// The right panel's slanted names have the left one's below-axis room to reach into.
constexpr std::size_t kPairColumns = 32;
constexpr double kPanel_cm = 6.0;  ///< at least, with what is above it
constexpr double kSpread = 0.6;    ///< of methods beside each other, in classes
constexpr double kHalfRow = 0.36;  ///< of the dots of one pair
/// Participants drawn as dots a pair; of more, evenly spaced ones in order of their difference.
constexpr std::size_t kMostPaths = 200;

double aside(std::size_t number, std::size_t count) {
  if (count < 2) return 0.0;
  return kSpread * (static_cast<double>(number) / static_cast<double>(count - 1) - 0.5);
}

std::vector<std::vector<double>> class_rows(const StudyReport& report, std::size_t number) {
  std::vector<std::vector<double>> rows;
  const std::vector<ClassAccuracy>& accuracy = report.methods[number].accuracy;
  for (std::size_t i = 0; i < accuracy.size(); ++i) {
    const std::optional<double> share = accuracy[i].accuracy.share();
    if (!share) continue;
    rows.push_back({static_cast<double>(i + 1) + aside(number, report.methods.size()),
                    100.0 * *share, 100.0 * accuracy[i].wilson.low,
                    100.0 * accuracy[i].wilson.high});
  }
  return rows;
}

/// Percentage points, rising, of participants who felt both.
std::vector<double> differences(const MethodReport& first, const MethodReport& second) {
  std::map<std::string, double> of_second;
  for (const ParticipantAccuracy& one : second.per_participant) {
    if (one.accuracy.share()) of_second[one.participant] = *one.accuracy.share();
  }
  std::vector<double> all;
  for (const ParticipantAccuracy& one : first.per_participant) {
    const auto found = of_second.find(one.participant);
    if (one.accuracy.share() && found != of_second.end()) {
      all.push_back(100.0 * (*one.accuracy.share() - found->second));
    }
  }
  std::sort(all.begin(), all.end());
  if (all.size() <= kMostPaths) return all;
  std::vector<double> thinned;
  for (std::size_t i = 0; i < kMostPaths; ++i) {
    thinned.push_back(all[i * (all.size() - 1) / (kMostPaths - 1)]);
  }
  return thinned;
}

/// Equal differences side by side, around the row of their pair.
std::vector<std::vector<double>> dots(const std::vector<double>& sorted, double at) {
  std::vector<std::vector<double>> rows;
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t end = first;
    while (end < sorted.size() && std::abs(sorted[end] - sorted[first]) < 1e-9) ++end;
    const auto count = static_cast<double>(end - first);
    const double step = std::min(0.07, 2.0 * kHalfRow / count);
    for (std::size_t i = first; i < end; ++i) {
      const double place = static_cast<double>(i - first) - 0.5 * (count - 1.0);
      rows.push_back({at + step * place, sorted[i]});
    }
    first = end;
  }
  return rows;
}

std::string classes_panel(const StudyReport& report, const NamesBelow& below) {
  std::string script = below.script() + accuracy_axis("correct, %") +
                       chance_line(static_cast<int>(report.classes.size()));
  std::string plot;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const std::string look =
        fmt::format("pt {} ps 0.75 lw 1.5 lc rgb '{}'", series_mark(i), series_colour(i));
    if (class_rows(report, i).empty()) continue;
    plot += fmt::format("{}$method{} using 1:2:3:4 with yerrorbars {} notitle",
                        plot.empty() ? "plot " : ", ", i, look);
  }
  return script + plot + "\n";
}

std::vector<LegendEntry> legend_of(const StudyReport& report) {
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    legend.push_back(mark_entry(series_mark(i), series_colour(i), report.methods[i].method));
  }
  legend.push_back(chance_entry(static_cast<int>(report.classes.size())));
  return legend;
}

std::string pair_name(const StudyReport& report, const MethodPair& pair) {
  return report.methods[static_cast<std::size_t>(pair.first)].method + " − " +
         report.methods[static_cast<std::size_t>(pair.second)].method;
}

std::string differences_panel(const StudyReport& report, const NamesBelow& below) {
  std::string data;
  std::string plot;
  std::vector<std::vector<double>> means;
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const MethodPair& pair = report.pairs[i];
    const std::vector<std::vector<double>> rows =
        dots(differences(report.methods[static_cast<std::size_t>(pair.first)],
                         report.methods[static_cast<std::size_t>(pair.second)]),
             static_cast<double>(i + 1));
    if (rows.empty() || !pair.overall.difference) continue;
    data += data_block(fmt::format("pair{}", i), rows);
    plot += fmt::format("{}$pair{} using 1:2 with points pt 7 ps 0.33 lc rgb '#7a7a7a' notitle",
                        plot.empty() ? "plot " : ", ", i);
    const double mean = *pair.overall.difference;
    const Interval bar = pair.overall.known_interval().value_or(Interval{mean, mean});
    means.push_back({static_cast<double>(i + 1), 100.0 * mean, 100.0 * bar.low, 100.0 * bar.high});
  }
  if (means.empty()) return {};
  return data + data_block("means", means) + "unset label\nunset arrow\n" + below.script() +
         "set yrange [*:*]\nset offsets 0, 0, 4, 4\nset ytics auto format '%+g'\nset ylabel "
         "'difference, percentage points'\n" +
         fmt::format(
             "set arrow from graph 0, first 0 to graph 1, first 0 nohead lw 1.2 lc rgb "
             "'{}' back\n",
             kInk) +
         plot +
         fmt::format(
             ", $means using 1:2:3:4 with yerrorbars pt 13 ps 1 lw 1.8 lc rgb '{}' "
             "notitle\n",
             kInk);
}

std::string alt_of_methods(const StudyReport& report) {
  std::string alt = "Accuracy by class and method, with 95 % Wilson intervals.";
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodReport& method = report.methods[i];
    alt += fmt::format(" {}:", method.method);
    for (std::size_t k = 0; k < method.accuracy.size() && k < report.classes.size(); ++k) {
      const ClassAccuracy& at = method.accuracy[k];
      if (!at.accuracy.share()) continue;
      alt +=
          fmt::format(" {} {};", report.classes[k], with_interval(*at.accuracy.share(), at.wilson));
    }
  }
  for (const MethodPair& pair : report.pairs) {
    if (!pair.overall.difference) continue;
    alt += fmt::format(" {}: {:+.1f} percentage points", pair_name(report, pair),
                       100.0 * *pair.overall.difference);
    if (const auto interval = pair.overall.known_interval()) {
      alt += fmt::format(" ({:+.1f} to {:+.1f})", 100.0 * interval->low, 100.0 * interval->high);
    }
    alt += fmt::format(", participants: {}.", pair.overall.participants);
  }
  return alt;
}

}  // namespace

std::optional<Figure> methods_figure(const StudyReport& report) {
  const bool any = std::any_of(report.methods.begin(), report.methods.end(),
                               [](const MethodReport& m) { return m.overall.n > 0; });
  if (report.methods.size() < 2 || !any) return {};
  Sheet sheet{16.0, 8.0, report.simulated};
  const bool paired =
      std::any_of(report.pairs.begin(), report.pairs.end(),
                  [](const MethodPair& p) { return p.overall.difference.has_value(); });
  Margins left;
  left.right_cm = paired ? kDifferences_cm : 0.4;
  Margins right = left;
  right.left_cm = sheet.width_cm - kDifferences_cm + 1.9;
  right.right_cm = 0.3;
  std::vector<std::string> pairs;
  for (const MethodPair& pair : report.pairs) pairs.push_back(pair_name(report, pair));
  const NamesBelow below(report.classes, sheet.width_cm - left.left_cm - left.right_cm);
  const NamesBelow below_pairs(pairs, sheet.width_cm - right.left_cm - right.right_cm,
                               kPairColumns);
  left.bottom_cm = std::max(below.room_cm(), paired ? below_pairs.room_cm() : 0.0) + 0.3;
  sheet.height_cm = std::max(sheet.height_cm, kPanel_cm + left.bottom_cm);
  const Legend legend(sheet, left.left_cm, legend_of(report));
  left.top_cm = legend.room_cm() + 0.3;
  right.bottom_cm = left.bottom_cm;
  right.top_cm = left.top_cm;

  Figure figure{.id = "methods", .caption = {}, .alt = alt_of_methods(report), .script = {}};
  figure.width_cm = sheet.width_cm;
  figure.height_cm = sheet.height_cm;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    figure.script += data_block(fmt::format("method{}", i), class_rows(report, i));
  }
  figure.script += sheet_head(sheet) + "set multiplot\n" + panel_at(sheet, left) + legend.script() +
                   classes_panel(report, below);
  if (paired) figure.script += panel_at(sheet, right) + differences_panel(report, below_pairs);
  figure.script += "unset multiplot\n";
  figure.caption = stamped(
      report.simulated,
      "methods side by side. Left: accuracy by presented class, all participants' trials pooled, "
      "with 95 % Wilson intervals." +
          std::string(paired ? " Right: each participant's difference (dots), and the mean with "
                               "its 95 % t interval over participants."
                             : ""));
  return figure;
}

}  // namespace touchtrial::analysis
