#include "bench/figures/plot.hpp"

#include "analysis/figures/gnuplot.hpp"

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#000000"};

constexpr const char* kStyle = R"(set encoding utf8
set border 3 lw 1.2
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1
set key at screen 0.59, screen 0.95 left top vertical Left reverse noenhanced samplen 2 spacing 1.3
set lmargin at screen 0.095
set rmargin at screen 0.575
set tmargin at screen 0.96
set bmargin 3.6
)";

std::string terminal(Format format, FigureSize size) {
  if (format == Format::png) {
    return fmt::format("set terminal pngcairo size {}, {} font 'DejaVu Sans,13'\n", size.width,
                       size.height);
  }
  return fmt::format(
      "set terminal svg size {}, {} dynamic font 'DejaVu Sans,Arial,sans-serif,13' "
      "background '#ffffff'\n",
      size.width, size.height);
}

}  // namespace

std::string figure_head(Format format, FigureSize size) {
  return terminal(format, size) + kStyle;
}

std::string plot_of(const std::vector<Curve>& curves, const std::string& style) {
  std::string data;
  std::string plot;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Curve& curve = curves[i];
    if (curve.points.empty()) continue;
    data += fmt::format("$curve{} << EOD\n", i);
    for (const auto& [x, y] : curve.points) data += fmt::format("{} {}\n", x, y);
    data += "EOD\n";
    plot += fmt::format("{}$curve{} with {} lc rgb '{}' pt {} ps 1.1 lw 1.8 title {}",
                        plot.empty() ? "plot " : ", ", i, style,
                        kColours[static_cast<std::size_t>(curve.colour)],
                        static_cast<int>(curve.mark), analysis::gnuplot_string(curve.title));
  }
  return data + plot + "\n";
}

}  // namespace touchtrial::bench
