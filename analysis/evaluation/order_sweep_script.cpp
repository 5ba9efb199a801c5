#include "analysis/evaluation/evaluation_report.hpp"
#include "analysis/figures/gnuplot.hpp"

#include <array>
#include <cstddef>
#include <filesystem>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Distinct for readers with any colour vision (Okabe and Ito).
constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#000000"};
/// gnuplot's filled and open marks; colours and marks come round at different
/// times.
constexpr std::array<int, 8> kMarks = {7, 5, 9, 11, 13, 6, 4, 8};

constexpr int kLegendColumns = 2;

constexpr const char* kStyle = R"(set encoding utf8
set border 3 lw 1.2
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1
set xrange [0:1]
set xtics 0.2
set mxtics 2
set xlabel 'fixed order v' noenhanced
unset key
)";

std::string data_of(const engine::Evaluation& evaluation, std::size_t number) {
  std::string data = fmt::format("$sweep{} << EOD\n", number);
  for (const engine::OrderFigures& figures : evaluation.orders) {
    data += fmt::format("{} {} {} {}\n", figures.order, figures.entropy, figures.ms_ssim,
                        figures.ms_ssim_wang);
  }
  return data + "EOD\n";
}

std::string colour_of(std::size_t number) {
  return kColours[number % kColours.size()];
}

std::string curve(std::size_t number, int column) {
  return fmt::format("$sweep{} using 1:{} with linespoints lc rgb '{}' pt {} ps 0.9 lw 1.6", number,
                     column, colour_of(number), kMarks[number % kMarks.size()]);
}

std::string entropy_panel(std::span<const EvaluatedImage> images) {
  std::string panel = "set ylabel 'entropy, nats' offset 1\nplot ";
  for (std::size_t i = 0; i < images.size(); ++i) {
    panel += fmt::format("{}{}, {} with lines dt (8, 5) lw 1.6 lc rgb '{}'", i == 0 ? "" : ", ",
                         curve(i, 2), images[i].evaluation.adaptive.entropy, colour_of(i));
  }
  return panel + "\n";
}

std::string likeness_panel(std::span<const EvaluatedImage> images) {
  std::string panel = "set ylabel 'MS-SSIM with the adaptive texture'\nset yrange [:1]\nplot ";
  for (std::size_t i = 0; i < images.size(); ++i) {
    panel += fmt::format("{}{}, $sweep{} using 1:4 with lines dt (2, 4) lw 1.6 lc rgb '{}'",
                         i == 0 ? "" : ", ", curve(i, 3), i, colour_of(i));
  }
  return panel + "\n";
}

/// A panel without axes: what the colours and the kinds of line stand for.
std::string legend_panel(std::span<const EvaluatedImage> images) {
  std::string panel =
      "unset border\nunset tics\nunset grid\nunset xlabel\nunset ylabel\n"
      "set xrange [0:1]\nset yrange [0:1]\n"
      "set lmargin at screen 0.02\nset rmargin at screen 0.98\n"
      "set key at screen 0.5, screen 0.015 center bottom horizontal Left reverse maxcols " +
      std::to_string(kLegendColumns) + " noenhanced width 2 samplen 3\nplot ";
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string name = std::filesystem::path(images[i].image).stem().string();
    panel += fmt::format("NaN with linespoints lc rgb '{}' pt {} ps 0.9 lw 1.6 title {}, ",
                         colour_of(i), kMarks[i % kMarks.size()], gnuplot_string(name));
  }
  return panel +
         "NaN with lines dt (8, 5) lw 1.6 lc rgb '#606060' title 'entropy of the adaptive "
         "texture', NaN with lines dt (2, 4) lw 1.6 lc rgb '#606060' title 'MS-SSIM with Wang''s "
         "weights'\n";
}

}  // namespace

std::string order_sweep_script(std::span<const EvaluatedImage> images) {
  const auto rows = (static_cast<int>(images.size()) + 2 + kLegendColumns - 1) / kLegendColumns;
  const int legend_px = 40 + 30 * rows;
  const int height_px = 620 + legend_px;
  const double floor = static_cast<double>(legend_px + 70) / height_px;
  std::string script = fmt::format(
      "set terminal pngcairo size 1500, {} font 'DejaVu Sans,15' linewidth 1.4\n", height_px);
  script += kStyle;
  for (std::size_t i = 0; i < images.size(); ++i) script += data_of(images[i].evaluation, i);
  script += fmt::format("set multiplot\nset tmargin at screen 0.97\nset bmargin at screen {:.4f}\n",
                        floor);
  script += "set lmargin at screen 0.07\nset rmargin at screen 0.485\n" + entropy_panel(images);
  script += "set lmargin at screen 0.565\nset rmargin at screen 0.985\n" + likeness_panel(images);
  return script + legend_panel(images) + "unset multiplot\n";
}

}  // namespace touchtrial::analysis
