#include "protocols/identification/analysis/figures/figures.hpp"

#include "analysis/report/figures/study_figures.hpp"
#include "analysis/report/figures/style.hpp"
#include "analysis/report/text_table.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// Cells are at least as wide as their numbers. If necessary, the sheet is wider than usual.
constexpr double kWidestCell_cm = 1.9;
constexpr double kNarrowestCell_cm = 1.0;
constexpr double kCellHeight_cm = 0.95;
constexpr double kNames_cm = 3.4;
constexpr double kUsualWidth_cm = 16.0;
constexpr double kGap = 0.25;  ///< before the column of missing answers, in widths of a cell

/// One cell at column x and row y, counted from 0 at the top left.
std::string cell(double x, int y, int count, int whole, bool right) {
  const double share = whole > 0 ? static_cast<double>(count) / whole : 0.0;
  const Rgb colour = shade_of(share);
  const std::string border =
      right ? fmt::format("border lc rgb '{}' lw 1.6", kInk) : "border lc rgb '#c8c8c8' lw 0.7";
  std::string script = fmt::format(
      "set object rectangle from first {}, {} to {}, {} fs solid 1 {} fc rgb "
      "'{}' {}\n",
      x, y, x + 1.0, y + 1.0, border, hexadecimal(colour), right ? "front" : "behind");
  const std::string ink =
      fmt::format("center front textcolor rgb '{}'", hexadecimal(ink_on(colour)));
  const bool bare = count == 0;  // a count of 0 stands without its share
  script += text_at(std::to_string(count),
                    fmt::format("first {}, {} {}", x + 0.5, y + (bare ? 0.5 : 0.32), ink));
  if (!bare) {
    script += text_at(fmt::format("{:.0f} %", 100.0 * share),
                      fmt::format("first {}, {} {}", x + 0.5, y + 0.7, ink));
  }
  return script;
}

std::string cells_of(const ConfusionMatrix& confusion) {
  const int classes = confusion.classes();
  std::string script;
  std::string diagonal;  // drawn last, so that its border is whole
  for (int row = 0; row < classes; ++row) {
    const int whole = confusion.presented(row);
    for (int column = 0; column < classes; ++column) {
      (row == column ? diagonal : script) +=
          cell(column, row, confusion.count(row, column), whole, row == column);
    }
    script += cell(classes + kGap, row, confusion.no_response(row), whole, false);
  }
  return script + diagonal;
}

std::string names_of(std::span<const std::string> classes, double cell_cm, bool slanted) {
  std::string script;
  const auto columns = static_cast<std::size_t>(cell_cm / 0.17);
  const char* how = slanted ? "left rotate by 45 offset 0, 0.4" : "center offset 0, 0.6";
  std::vector<std::string> answers(classes.begin(), classes.end());
  answers.emplace_back(slanted ? "no response" : "none");
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const double x = static_cast<double>(i) + 0.5 + (i == classes.size() ? kGap : 0.0);
    script += text_at(fitted(answers[i], slanted ? 16 : std::max<std::size_t>(columns, 1)),
                      fmt::format("first {}, graph 1 {}", x, how));
  }
  for (std::size_t i = 0; i < classes.size(); ++i) {
    script += text_at(fitted(classes[i], 16), fmt::format("graph 0, first {} right offset -0.7, 0",
                                                          static_cast<double>(i) + 0.5));
  }
  return script;
}

std::string alt_of_confusions(const StudyReport& report, const MethodReport& method) {
  std::string alt = "Confusion matrix of " + method.method + ", rows presented, columns answered.";
  for (int row = 0; row < method.confusion.classes(); ++row) {
    alt += fmt::format(" {}:", report.classes[static_cast<std::size_t>(row)]);
    for (int column = 0; column < method.confusion.classes(); ++column) {
      alt += fmt::format(" {}", method.confusion.count(row, column));
    }
    alt += fmt::format(", no response {}.", method.confusion.no_response(row));
  }
  return alt;
}

Figure confusion_figure(const StudyReport& report, std::size_t number) {
  const MethodReport& method = report.methods[number];
  const int classes = method.confusion.classes();
  const double columns = classes + 1.0 + kGap;
  const double cell_cm =
      std::clamp((kUsualWidth_cm - kNames_cm - 0.6) / columns, kNarrowestCell_cm, kWidestCell_cm);
  std::size_t widest = 0;
  for (const std::string& name : report.classes) widest = std::max(widest, display_width(name));
  const bool slanted = static_cast<double>(widest) * 0.17 > cell_cm;
  Margins margins;
  margins.left_cm = kNames_cm;
  margins.right_cm = slanted ? 1.8 : 0.6;
  margins.top_cm =
      1.5 + (slanted ? 0.12 * static_cast<double>(std::clamp<std::size_t>(widest, 11, 16)) : 0.0);
  margins.bottom_cm = 0.3;
  const Sheet sheet{kNames_cm + columns * cell_cm + margins.right_cm,
                    margins.top_cm + margins.bottom_cm + classes * kCellHeight_cm,
                    report.simulated};

  Figure figure = figure_on(sheet, fmt::format("confusion-{}", number + 1),
                            alt_of_confusions(report, method), "confusions");
  figure.caption = stamped(
      report.simulated,
      fmt::format("confusions with method {}. Rows are the presented class, columns the answer; "
                  "counts of all participants' trials, and per cent of the row. The right answers "
                  "are framed.",
                  method.method));
  figure.script =
      sheet_head(sheet) + panel_at(sheet, margins) +
      fmt::format(
          "unset border\nunset tics\nunset grid\nset xrange [0:{}]\nset yrange "
          "[{}:0]\n",
          columns, classes) +
      names_of(report.classes, cell_cm, slanted) + cells_of(method.confusion) +
      text_on_sheet(sheet, "answered", kNames_cm, 0.3) +
      text_on_sheet(sheet, "presented", kNames_cm - 0.25, margins.top_cm - 0.35, "right") +
      "plot NaN notitle\n";
  return figure;
}

/// Confusion matrices, one for each method.
std::vector<Figure> confusion_figures(const StudyReport& report) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const bool named =
        report.methods[i].confusion.classes() == static_cast<int>(report.classes.size());
    if (named && report.methods[i].confusion.accuracy().n > 0) {
      figures.push_back(confusion_figure(report, i));
    }
  }
  return figures;
}

}  // namespace

std::vector<Figure> report_figures(const StudyReport& report, const FigureOptions& options) {
  std::vector<Figure> figures;
  const auto add = [&figures](std::optional<Figure> figure) {
    if (figure) figures.push_back(*std::move(figure));
  };
  add(flow_figure(report));
  add(accuracy_figure(report, options.paper_values));
  add(methods_figure(report));
  add(participants_figure(report));
  for (Figure& figure : confusion_figures(report)) figures.push_back(std::move(figure));
  add(trials_figure(report));
  add(reaction_figure(report));
  if (options.cues != nullptr) add(cues_figure(*options.cues));
  add(servo_figure(report, "servo-and-validity"));
  for (const ExplorationPath& path : options.explorations) figures.push_back(path_figure(path));
  stamp_figures(options.stamp, figures);
  return figures;
}

}  // namespace touchtrial::analysis::identification
