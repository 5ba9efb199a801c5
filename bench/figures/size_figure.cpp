#include "bench/cases/cases.hpp"
#include "bench/figures/figures.hpp"
#include "bench/figures/plot.hpp"

#include <algorithm>

namespace touchtrial::bench {
namespace {

constexpr FigureSize kSize = {1000, 420};

Curve curve_of(const std::vector<Row>& rows, const std::string& work, const std::string& who,
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

}  // namespace

std::string size_figure(const std::vector<Row>& rows, Format format) {
  const std::vector<Curve> curves = {
      curve_of(rows, "extraction, force", "OpenCV ring sums", Colour::vermilion, Mark::square),
      curve_of(rows, "extraction", "OpenCV ring sums", Colour::vermilion, Mark::open_square),
      curve_of(rows, "extraction, force", "OpenCV ring sums, tuned", Colour::orange,
               Mark::triangle),
      curve_of(rows, "extraction", "OpenCV ring sums, tuned", Colour::orange, Mark::open_triangle),
      curve_of(rows, "extraction, force", our_name(), Colour::blue, Mark::disc),
      curve_of(rows, "extraction", our_name(), Colour::blue, Mark::circle)};
  return figure_head(format, kSize) +
         "set logscale xy\nset xlabel 'side of the image, pixels'\n"
         "set ylabel 'time, nanoseconds a pixel' offset 1\n"
         "set xtics (64, 128, 256, 500, 1024, 2048, 4096, 8192)\nset xrange [56:9400]\nset yrange "
         "[0.5:50]\n"
         "set ytics add (0.5, 1, 2, 5, 10, 20, 50)\n" +
         plot_of(curves, "linespoints");
}

}  // namespace touchtrial::bench
