#include "analysis/paper/published.hpp"
#include "analysis/report/figures/style.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

/// The width of the part of the sheet that shows participants' differences.
constexpr double kDifferences_cm = 6.0;
/// The columns to which slanted names of pairs are cut. The names of the right panel may reach into
/// the room below the left panel.
constexpr std::size_t kPairColumns = 32;
constexpr double kPanel_cm = 6.0;  ///< least height of a panel and the room above it
constexpr double kSpread = 0.6;    ///< width of the methods of one class, in widths of a class
constexpr double kHalfRow = 0.36;  ///< half the width of the dots of one pair
/// The most participants that are drawn as dots for each pair of methods.
constexpr std::size_t kMaxDifferences = 200;

double aside(std::size_t number, std::size_t count) {
  if (count < 2) return 0.0;
  return kSpread * (static_cast<double>(number) / static_cast<double>(count - 1) - 0.5);
}

/// What is drawn of a class: over participants, or as if trials were independent.
struct DrawnAccuracy {
  double share = 0.0;
  Interval interval;
};

std::optional<DrawnAccuracy> drawn_accuracy(const ClassAccuracy& accuracy) {
  const std::optional<double> share = accuracy.accuracy.share();
  if (!share) return std::nullopt;
  if (!accuracy.has_interval_over_participants()) return DrawnAccuracy{*share, accuracy.wilson};
  return DrawnAccuracy{*accuracy.mean.mean, accuracy.mean.interval};
}

/// What the intervals are, for captions and legends.
std::string interval_name(const StudyReport& report) {
  bool over_participants = false;
  bool of_trials = false;
  for (const MethodReport& method : report.methods) {
    for (const ClassAccuracy& one : method.accuracy) {
      (one.has_interval_over_participants() ? over_participants : of_trials) = true;
    }
  }
  if (!over_participants) return "Wilson interval (trials as if independent)";
  return of_trials ? "t interval over participants (Wilson, of trials, where they do not differ)"
                   : "t interval over participants";
}

Rows class_rows(const StudyReport& report, std::size_t number) {
  Rows rows;
  const std::vector<ClassAccuracy>& accuracy = report.methods[number].accuracy;
  for (std::size_t i = 0; i < accuracy.size(); ++i) {
    const std::optional<DrawnAccuracy> one = drawn_accuracy(accuracy[i]);
    if (!one) continue;
    add_bar(rows, static_cast<double>(i + 1) + aside(number, report.methods.size()), one->share,
            one->interval, 100.0);
  }
  return rows;
}

/// The differences of the participants who felt both methods, in percentage points, ascending.
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
  return evenly_chosen(all, kMaxDifferences);
}

/// The places of the dots: equal differences stand side by side around the place of their pair.
Rows dots(const std::vector<double>& sorted, double at) {
  Rows rows;
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

std::vector<LegendEntry> legend_of_methods(const StudyReport& report) {
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
  Rows means;
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const MethodPair& pair = report.pairs[i];
    const Rows rows = dots(differences(report.methods[static_cast<std::size_t>(pair.first)],
                                       report.methods[static_cast<std::size_t>(pair.second)]),
                           static_cast<double>(i + 1));
    if (rows.empty() || !pair.overall.difference) continue;
    data += data_block(fmt::format("pair{}", i), rows);
    plot += fmt::format("{}$pair{} using 1:2 with points pt 7 ps 0.33 lc rgb '#7a7a7a' notitle",
                        plot.empty() ? "plot " : ", ", i);
    add_bar(means, static_cast<double>(i + 1), *pair.overall.difference,
            pair.overall.known_interval(), 100.0);
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
  std::string alt = "Accuracy by class and method, with 95 % " + interval_name(report) + ".";
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodReport& method = report.methods[i];
    alt += fmt::format(" {}:", method.method);
    for (std::size_t k = 0; k < method.accuracy.size() && k < report.classes.size(); ++k) {
      const auto at = drawn_accuracy(method.accuracy[k]);
      if (!at) continue;
      alt += fmt::format(" {} {};", report.classes[k], with_interval(at->share, at->interval));
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

/// The paper's name for an image of its Fig. 6.
std::string paper_image(std::size_t i) {
  return fmt::format("image {}", i + 1);
}

/// The label in lower case, with spaces instead of hyphens and underscores.
std::string plain_name(std::string_view label) {
  std::string plain;
  for (const char c : label) {
    const auto byte = static_cast<unsigned char>(c);
    plain += c == '-' || c == '_' ? ' ' : static_cast<char>(std::tolower(byte));
  }
  return plain;
}

/// The marks of the paper's values. A value stands beside the class that has its image's name, or
/// otherwise in a column of its own.
Rows paper_rows(std::span<const std::string> classes) {
  Rows rows;
  const auto column = static_cast<double>(classes.size()) + 1.0;
  for (std::size_t i = 0; i < kPublishedPercents.size(); ++i) {
    const auto found = std::find_if(classes.begin(), classes.end(), [i](const std::string& label) {
      return plain_name(label) == paper_image(i);
    });
    const double x = found == classes.end() ? column + 0.15 * (static_cast<double>(i) - 2.0)
                                            : static_cast<double>(found - classes.begin()) + 1.25;
    rows.push_back({x, static_cast<double>(kPublishedPercents[i])});
  }
  return rows;
}

bool has_column(const Rows& paper, std::size_t classes) {
  return std::any_of(paper.begin(), paper.end(), [classes](const std::vector<double>& row) {
    return row[0] > static_cast<double>(classes) + 0.5;
  });
}

std::string alt_of_accuracy(const StudyReport& report) {
  std::string alt = "Accuracy by class, with 95 % " + interval_name(report) + ":";
  const MethodReport& method = report.methods.front();
  for (std::size_t i = 0; i < method.accuracy.size(); ++i) {
    const ClassAccuracy& at = method.accuracy[i];
    const auto drawn = drawn_accuracy(at);
    if (!drawn) continue;
    alt += fmt::format(" {} {}, {} of {};", report.classes[i],
                       with_interval(drawn->share, drawn->interval), at.accuracy.correct,
                       at.accuracy.n);
  }
  return alt + fmt::format(" chance {:.1f} %.", 100.0 / static_cast<double>(report.classes.size()));
}

std::vector<LegendEntry> legend_of_accuracy(bool paper, int classes) {
  std::vector<LegendEntry> legend = {
      mark_entry(series_mark(0), series_colour(0), "correct, with 95 % interval"),
      chance_entry(classes)};
  if (paper) {
    legend.push_back(mark_entry(6, series_colour(1), "paper (other images, other device)"));
  }
  return legend;
}

std::string plot_of(bool paper) {
  std::string plot = fmt::format(
      "plot $accuracy using 1:2:3:4 with yerrorbars pt {} ps 0.8 lw 1.5 lc rgb '{}' notitle, "
      "$accuracy using 1:2:(sprintf('%.0f', $2)) with labels left offset 0.7, 0 textcolor rgb "
      "'{}' notitle",
      series_mark(0), series_colour(0), kInk);
  if (paper) {
    plot += fmt::format(", $paper using 1:2 with points pt 6 ps 0.9 lw 1.3 lc rgb '{}' notitle",
                        series_colour(1));
  }
  return plot + "\n";
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
  const Legend legend(sheet, left.left_cm, legend_of_methods(report));
  left.top_cm = legend.room_cm() + 0.3;
  right.bottom_cm = left.bottom_cm;
  right.top_cm = left.top_cm;

  Figure figure = figure_on(sheet, "methods", alt_of_methods(report), "methods-compared");
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    figure.script += data_block(fmt::format("method{}", i), class_rows(report, i));
  }
  figure.script += sheet_head(sheet) + "set multiplot\n" + panel_at(sheet, left) + legend.script() +
                   classes_panel(report, below);
  if (paired) figure.script += panel_at(sheet, right) + differences_panel(report, below_pairs);
  figure.script += "unset multiplot\n";
  figure.caption = stamped(
      report.simulated,
      "methods side by side. Left: accuracy by presented class with its 95 % " +
          interval_name(report) + "." +
          std::string(paired ? " Right: each participant's difference (dots), and the mean with "
                               "its 95 % t interval over participants."
                             : ""));
  return figure;
}

std::optional<Figure> accuracy_figure(const StudyReport& report, bool paper_values) {
  if (report.methods.size() != 1) return {};
  const Rows rows = class_rows(report, 0);
  if (rows.empty()) return {};
  const Rows paper = paper_values ? paper_rows(report.classes) : Rows{};
  std::vector<std::string> names = report.classes;
  if (has_column(paper, names.size())) names.emplace_back("(paper)");
  const Sheet sheet{16.0, 8.0, report.simulated};
  Margins margins;
  const NamesBelow below(names, sheet.width_cm - margins.left_cm - margins.right_cm);
  margins.bottom_cm = below.room_cm() + 0.3;
  const auto classes = static_cast<int>(report.classes.size());
  const Legend legend(sheet, margins.left_cm, legend_of_accuracy(paper_values, classes));
  margins.top_cm = legend.room_cm() + 0.2;

  Figure figure = figure_on(sheet, "accuracy-by-class", alt_of_accuracy(report), "accuracy");
  figure.caption = stamped(report.simulated, "accuracy by presented class with its 95 % " +
                                                 interval_name(report) +
                                                 ". Trials without a response are wrong.");
  if (paper_values) {
    figure.caption +=
        " Open marks: accuracies published for five images, which are other images felt on another "
        "device.";
  }
  figure.script = data_block("accuracy", rows);
  if (paper_values) figure.script += data_block("paper", paper);
  figure.script += sheet_head(sheet) + panel_at(sheet, margins) + below.script() +
                   accuracy_axis("correct, %") + chance_line(classes) + legend.script() +
                   plot_of(paper_values);
  return figure;
}

}  // namespace touchtrial::analysis::identification
