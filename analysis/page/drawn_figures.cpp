#include "analysis/page/drawn_figures.hpp"

#include "analysis/figures/figures.hpp"
#include "analysis/figures/gnuplot.hpp"
#include "core/errors.hpp"

namespace touchtrial::analysis {
namespace {

/// Why gnuplot cannot be used; empty if it can.
std::string gnuplot_complaint() {
  try {
    require_gnuplot();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace

DrawnFigures draw_report_figures(const std::vector<Figure>& figures) {
  DrawnFigures drawn;
  drawn.missing = gnuplot_complaint();
  std::vector<std::string> svg(figures.size());
  if (drawn.missing.empty()) {
    svg = all_drawn(figures, FigureFormat::svg);
    const std::vector<std::string> pdf = all_drawn(figures, FigureFormat::pdf);
    for (std::size_t i = 0; i < figures.size(); ++i) {
      drawn.files["figures/" + figures[i].id + ".svg"] = svg[i];
      drawn.files["figures/" + figures[i].id + ".pdf"] = pdf[i];
    }
  }
  for (std::size_t i = 0; i < figures.size(); ++i) {
    drawn.pictures.push_back({figures[i].id, figures[i].caption, figures[i].alt, svg[i]});
  }
  return drawn;
}

}  // namespace touchtrial::analysis
