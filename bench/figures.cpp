#include "bench/figures.hpp"

#include "analysis/figures/gnuplot.hpp"
#include "bench/cases/cases.hpp"
#include "bench/gnuplot_terminal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

/// Distinct for readers with any colour vision (Okabe and Ito, 2008).
enum class Colour { blue, vermilion, green, orange, sky };
constexpr std::array<const char*, 5> kColours = {"#0072b2", "#d55e00", "#009e73", "#e69f00",
                                                 "#56b4e9"};

/// The numbers of gnuplot's filled marks, then of the open ones.
enum class Mark {
  disc = 7,
  square = 5,
  triangle = 9,
  inverted = 11,
  diamond = 13,
  circle = 6,
  open_square = 4,
  open_triangle = 8
};

struct Curve {
  std::string title;
  Colour colour;
  Mark mark;
  std::vector<std::pair<double, double>> points;
};

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

constexpr int kWidthPx = 1000;
constexpr int kHeightPx = 420;

/// Terminal, fonts, borders and grid.
std::string figure_head(int height_px = kHeightPx) {
  return gnuplot_terminal(false, kWidthPx, height_px) + kStyle;
}

/// The data of all curves that have points, and the command that plots them.
/// \param style  "points" or "linespoints"
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

/// Stands for an error of zero, which has no logarithm.
constexpr double kLeastError = 1e-16;

constexpr Mark kErrorMarks[] = {Mark::disc,        Mark::square,       Mark::triangle,
                                Mark::inverted,    Mark::diamond,      Mark::circle,
                                Mark::open_square, Mark::open_triangle};

/// Of the engine, of OpenCV and of plain loops.
Colour colour_of(const Row& row) {
  if (row.what.who.starts_with("touchtrial")) return Colour::blue;
  return row.what.who.starts_with("OpenCV") ? Colour::vermilion : Colour::green;
}

/// One point for each row; the marks of one colour differ.
/// \param names_work  whether the legend names the work
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
                      kErrorMarks[mark++ % std::size(kErrorMarks)],
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

/// Error against time of the fractional filters on the usual picture, K = 2.
std::string filter_figure(const std::vector<Row>& rows) {
  std::vector<Row> filters;
  for (const Row& row : rows) {
    if (row.what.work.starts_with("G-L") && row.what.size_px == kUsualSize_px &&
        row.what.radius == kUsualRadius) {
      filters.push_back(row);
    }
  }
  return figure_head() + error_axes("largest error, grey levels") +
         plot_of(points_of(filters, true), "points");
}

/// Error against time of MS-SSIM.
std::string ms_ssim_figure(const std::vector<Row>& rows) {
  std::vector<Row> metrics;
  for (const Row& row : rows) {
    if (row.what.work == "MS-SSIM" && row.what.size_px == kUsualSize_px) metrics.push_back(row);
  }
  return figure_head() + error_axes("error of MS-SSIM") +
         plot_of(points_of(metrics, false), "points");
}

Curve size_curve(const std::vector<Row>& rows, const std::string& work, const std::string& who,
                 Colour colour, Mark mark) {
  Curve curve{who + (work == "extraction" ? ", texture" : ", and force"), colour, mark, {}};
  for (const Row& row : rows) {
    if (row.what.work != work || row.what.who != who || row.what.radius != kUsualRadius) continue;
    const double pixels = static_cast<double>(row.what.size_px) * row.what.size_px;
    curve.points.emplace_back(row.what.size_px, 1e3 * row.us / pixels);
  }
  std::sort(curve.points.begin(), curve.points.end());
  return curve;
}

/// Time per pixel of whole extractions against the side of the image.
std::string size_figure(const std::vector<Row>& rows) {
  const std::vector<Curve> curves = {
      size_curve(rows, "extraction, force", "OpenCV ring sums", Colour::vermilion, Mark::square),
      size_curve(rows, "extraction", "OpenCV ring sums", Colour::vermilion, Mark::open_square),
      size_curve(rows, "extraction, force", "OpenCV ring sums, tuned", Colour::orange,
                 Mark::triangle),
      size_curve(rows, "extraction", "OpenCV ring sums, tuned", Colour::orange,
                 Mark::open_triangle),
      size_curve(rows, "extraction, force", our_name(), Colour::blue, Mark::disc),
      size_curve(rows, "extraction", our_name(), Colour::blue, Mark::circle)};
  return figure_head() +
         "set logscale xy\nset xlabel 'side of the image, pixels'\n"
         "set ylabel 'time, nanoseconds a pixel' offset 1\n"
         "set xtics (64, 128, 256, 500, 1024, 2048, 4096, 8192)\nset xrange [56:9400]\nset yrange "
         "[0.5:50]\n"
         "set ytics add (0.5, 1, 2, 5, 10, 20, 50)\n" +
         plot_of(curves, "linespoints");
}

constexpr Colour kCourseColours[] = {Colour::blue, Colour::sky, Colour::green, Colour::vermilion};
constexpr Mark kCourseMarks[] = {Mark::disc, Mark::circle, Mark::triangle, Mark::square};

/// \param value  of a point, to draw against time
template <class Value>
std::vector<Curve> course_curves(const std::vector<SolverCourse>& courses, Value value) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    Curve curve{courses[i].solver, kCourseColours[i], kCourseMarks[i], {}};
    for (const CoursePoint& point : courses[i].points) {
      curve.points.emplace_back(1e-3 * point.us, value(point));
    }
    curves.push_back(curve);
  }
  return curves;
}

/// Error of v and gap of TV-Gabor's solvers over time, side by side.
std::string tv_gabor_figure(const std::vector<SolverCourse>& courses) {
  return figure_head(440) +
         "set logscale xy\nset format xy '10^{%L}'\nset xlabel 'time, milliseconds'\n"
         "set multiplot\nset lmargin at screen 0.085\nset rmargin at screen 0.405\n"
         "set ylabel 'error of v, relative' offset 1\nset key off\n" +
         plot_of(course_curves(courses, [](const CoursePoint& point) { return point.error; }),
                 "linespoints") +
         "set lmargin at screen 0.49\nset rmargin at screen 0.81\nset ylabel 'gap' offset 1\n"
         "set key on at screen 0.82, screen 0.95 left top vertical Left reverse\n" +
         plot_of(course_curves(courses, [](const CoursePoint& point) { return point.gap; }),
                 "linespoints") +
         "unset multiplot\n";
}

}  // namespace

void draw_figures(const std::vector<Row>& rows, const std::vector<SolverCourse>& courses,
                  const std::filesystem::path& folder) {
  analysis::draw_with_gnuplot(filter_figure(rows), folder / "filters.svg");
  analysis::draw_with_gnuplot(ms_ssim_figure(rows), folder / "ms-ssim.svg");
  analysis::draw_with_gnuplot(size_figure(rows), folder / "sizes.svg");
  analysis::draw_with_gnuplot(tv_gabor_figure(courses), folder / "tv-gabor.svg");
}

}  // namespace touchtrial::bench
