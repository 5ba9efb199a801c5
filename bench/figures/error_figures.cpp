#include "bench/cases/cases.hpp"
#include "bench/figures/figures.hpp"
#include "bench/figures/plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial::bench {
namespace {

constexpr FigureSize kSize = {1000, 420};
/// Drawn for an error of nothing, which has no logarithm.
constexpr double kLeastError = 1e-16;

constexpr Mark kMarks[] = {Mark::disc,    Mark::square, Mark::triangle,    Mark::inverted,
                           Mark::diamond, Mark::circle, Mark::open_square, Mark::open_triangle};

/// Ours, OpenCV's, and the plain ones.
Colour colour_of(const Row& row) {
  if (row.what.who.starts_with("touchtrial")) return Colour::blue;
  return row.what.who.starts_with("OpenCV") ? Colour::vermilion : Colour::green;
}

/// One point a row; marks differ within a colour.
std::vector<Curve> points_of(std::vector<Row> rows, bool names_work) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return colour_of(a) < colour_of(b); });
  std::vector<Curve> curves;
  std::size_t mark = 0;
  for (const Row& row : rows) {
    if (!curves.empty() && curves.back().colour != colour_of(row)) mark = 0;
    const std::string what = names_work ? row.what.work.substr(row.what.work.rfind(' ') + 1) : "";
    const std::string input = colour_of(row) == Colour::vermilion ? ", " + row.what.input : "";
    curves.push_back({row.what.who + (what.empty() ? "" : ", " + what) + input,
                      colour_of(row),
                      kMarks[mark++ % std::size(kMarks)],
                      {{row.us, std::max(row.error, kLeastError)}}});
  }
  return curves;
}

std::string error_axes(const std::string& y_label) {
  return "set logscale xy\nset format x '10^{%L}'\nset format y '10^{%L}'\nset offsets "
         "graph 0.05, graph 0.05, graph 0.06, graph 0.06\n"
         "set xlabel 'time of one run, microseconds'\nset ylabel '" +
         y_label + "' offset 1\n";
}

}  // namespace

std::string filter_figure(const std::vector<Row>& rows, Format format) {
  std::vector<Row> filters;
  for (const Row& row : rows) {
    if (row.what.work.starts_with("G-L") && row.what.size_px == kUsualSize_px &&
        row.what.radius == kUsualRadius) {
      filters.push_back(row);
    }
  }
  return figure_head(format, kSize) + error_axes("largest error, grey levels") +
         plot_of(points_of(filters, true), "points");
}

std::string ms_ssim_figure(const std::vector<Row>& rows, Format format) {
  std::vector<Row> metrics;
  for (const Row& row : rows) {
    if (row.what.work == "MS-SSIM" && row.what.size_px == kUsualSize_px) metrics.push_back(row);
  }
  return figure_head(format, kSize) + error_axes("error of MS-SSIM") +
         plot_of(points_of(metrics, false), "points");
}

}  // namespace touchtrial::bench
