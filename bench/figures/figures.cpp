#include "bench/figures/figures.hpp"

#include "analysis/figures/gnuplot.hpp"

namespace touchtrial::bench {

void draw_figures(const std::vector<Row>& rows, const std::vector<SolverCourse>& courses,
                  Format format, const std::filesystem::path& folder) {
  const std::string ending = format == Format::svg ? ".svg" : ".png";
  analysis::draw_with_gnuplot(filter_figure(rows, format), folder / ("filters" + ending));
  analysis::draw_with_gnuplot(ms_ssim_figure(rows, format), folder / ("ms-ssim" + ending));
  analysis::draw_with_gnuplot(size_figure(rows, format), folder / ("sizes" + ending));
  analysis::draw_with_gnuplot(tv_gabor_figure(courses, format), folder / ("tv-gabor" + ending));
}

}  // namespace touchtrial::bench
