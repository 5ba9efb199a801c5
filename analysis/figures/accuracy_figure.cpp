#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/style.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Fig. 6 of the source paper, per cent; its images have no names but these.
struct PaperValue {
  std::string_view image;
  double percent;
};
constexpr std::array<PaperValue, 5> kPaper = {{{"image 1", 87.0},
                                               {"image 2", 72.0},
                                               {"image 3", 81.0},
                                               {"image 4", 91.0},
                                               {"image 5", 83.0}}};
constexpr Sheet kSheet{16.0, 8.0, false};

/// In lower case, with spaces for hyphens and underlines.
std::string plain_name(std::string_view label) {
  std::string plain;
  for (const char c : label) {
    const auto byte = static_cast<unsigned char>(c);
    plain += c == '-' || c == '_' ? ' ' : static_cast<char>(std::tolower(byte));
  }
  return plain;
}

std::vector<std::vector<double>> rows_of(const MethodReport& method) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < method.accuracy.size(); ++i) {
    const ClassAccuracy& at = method.accuracy[i];
    const std::optional<double> share = at.accuracy.share();
    if (!share) continue;
    rows.push_back({static_cast<double>(i + 1), 100.0 * *share, 100.0 * at.wilson.low,
                    100.0 * at.wilson.high});
  }
  return rows;
}

/// Beside the class of that name, else in a column of their own, side by side.
std::vector<std::vector<double>> paper_rows(std::span<const std::string> classes) {
  std::vector<std::vector<double>> rows;
  const auto column = static_cast<double>(classes.size()) + 1.0;
  for (std::size_t i = 0; i < kPaper.size(); ++i) {
    const auto found = std::find_if(classes.begin(), classes.end(), [i](const std::string& label) {
      return plain_name(label) == kPaper[i].image;
    });
    const double x = found == classes.end() ? column + 0.15 * (static_cast<double>(i) - 2.0)
                                            : static_cast<double>(found - classes.begin()) + 1.25;
    rows.push_back({x, kPaper[i].percent});
  }
  return rows;
}

bool has_column(std::span<const std::vector<double>> paper, std::size_t classes) {
  return std::any_of(paper.begin(), paper.end(), [classes](const std::vector<double>& row) {
    return row[0] > static_cast<double>(classes) + 0.5;
  });
}

std::string alt_of_accuracy(const StudyReport& report) {
  std::string alt = "Accuracy by class, with 95 % Wilson intervals:";
  const MethodReport& method = report.methods.front();
  for (std::size_t i = 0; i < method.accuracy.size(); ++i) {
    const ClassAccuracy& at = method.accuracy[i];
    if (!at.accuracy.share()) continue;
    alt += fmt::format(" {} {}, {} of {};", report.classes[i],
                       with_interval(*at.accuracy.share(), at.wilson), at.accuracy.correct,
                       at.accuracy.n);
  }
  return alt + fmt::format(" chance {:.1f} %.", 100.0 / static_cast<double>(report.classes.size()));
}

std::vector<LegendEntry> legend_of(bool paper, int classes) {
  std::vector<LegendEntry> legend = {
      mark_entry(series_mark(0), series_colour(0), "correct, with 95 % Wilson interval"),
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

std::optional<Figure> accuracy_figure(const StudyReport& report, bool paper_values) {
  if (report.methods.size() != 1) return {};
  const std::vector<std::vector<double>> rows = rows_of(report.methods.front());
  if (rows.empty()) return {};
  const std::vector<std::vector<double>> paper =
      paper_values ? paper_rows(report.classes) : std::vector<std::vector<double>>{};
  std::vector<std::string> names = report.classes;
  if (has_column(paper, names.size())) names.emplace_back("(paper)");
  Sheet sheet = kSheet;
  sheet.simulated = report.simulated;
  Margins margins;
  const NamesBelow below(names, sheet.width_cm - margins.left_cm - margins.right_cm);
  margins.bottom_cm = below.room_cm() + 0.3;
  const auto classes = static_cast<int>(report.classes.size());
  const Legend legend(sheet, margins.left_cm, legend_of(paper_values, classes));
  margins.top_cm = legend.room_cm() + 0.2;

  Figure figure{
      .id = "accuracy-by-class", .caption = {}, .alt = alt_of_accuracy(report), .script = {}};
  figure.width_cm = sheet.width_cm;
  figure.height_cm = sheet.height_cm;
  figure.caption = stamped(
      report.simulated,
      "accuracy by presented class. Bars are 95 % Wilson intervals of all participants' trials "
      "pooled: they leave out how much participants differ. Trials without a response are wrong.");
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

}  // namespace touchtrial::analysis
