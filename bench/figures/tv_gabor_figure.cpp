#include "bench/figures/figures.hpp"
#include "bench/figures/plot.hpp"

#include <cstddef>

namespace touchtrial::bench {
namespace {

constexpr FigureSize kSize = {1000, 440};
constexpr Colour kColours[] = {Colour::blue, Colour::sky, Colour::green, Colour::vermilion};
constexpr Mark kMarks[] = {Mark::disc, Mark::circle, Mark::triangle, Mark::square};

/// \param figure  of a point, to draw against time
template <class Figure>
std::vector<Curve> curves_of(const std::vector<SolverCourse>& courses, Figure figure) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    Curve curve{courses[i].solver, kColours[i], kMarks[i], {}};
    for (const CoursePoint& point : courses[i].points) {
      curve.points.emplace_back(1e-3 * point.us, figure(point));
    }
    curves.push_back(curve);
  }
  return curves;
}

}  // namespace

std::string tv_gabor_figure(const std::vector<SolverCourse>& courses, Format format) {
  return figure_head(format, kSize) +
         "set logscale xy\nset format xy '10^{%L}'\nset xlabel 'time, milliseconds'\n"
         "set multiplot\nset lmargin at screen 0.085\nset rmargin at screen 0.405\n"
         "set ylabel 'error of v, relative' offset 1\nset key off\n" +
         plot_of(curves_of(courses, [](const CoursePoint& point) { return point.error; }),
                 "linespoints") +
         "set lmargin at screen 0.49\nset rmargin at screen 0.81\nset ylabel 'gap' offset 1\n"
         "set key on at screen 0.82, screen 0.95 left top vertical Left reverse\n" +
         plot_of(curves_of(courses, [](const CoursePoint& point) { return point.gap; }),
                 "linespoints") +
         "unset multiplot\n";
}

}  // namespace touchtrial::bench
