#include "analysis/report/figures/figure.hpp"

#include "analysis/report/figures/gnuplot.hpp"
#include "analysis/report/figures/gnuplot_script.hpp"
#include "analysis/report/figures/svg.hpp"
#include "core/errors.hpp"

#include <algorithm>

namespace touchtrial::analysis {
namespace {

/// More processes at the same time would only take memory.
constexpr std::size_t kMaxProcesses = 8;

/// Replaces the creation time, so that equal figures give equal files. Cairo 1.18 and later
/// compress it with other metadata; it then remains (docs/report.md).
std::string with_fixed_time(std::string pdf) {
  static constexpr std::string_view kCreationDate = "/CreationDate (D:";
  static constexpr std::string_view kEpoch = "19700101000000";
  const std::size_t position = pdf.find(kCreationDate);
  if (position != std::string::npos &&
      position + kCreationDate.size() + kEpoch.size() <= pdf.size()) {
    pdf.replace(position + kCreationDate.size(), kEpoch.size(), kEpoch);
  }
  return pdf;
}

GnuplotProcess start_drawing(const Figure& figure, FigureFormat format) {
  const Layout layout = layout_of(figure);
  return {"", gnuplot_terminal(figure, layout, format) + gnuplot_script(figure, layout)};
}

std::string finish_drawing(GnuplotProcess& process, const Figure& figure, FigureFormat format) {
  std::string file = process.result();
  if (file.empty()) {
    throw Error("figure " + figure.id + ": gnuplot drew nothing" + gnuplot_remedy());
  }
  return format == FigureFormat::svg ? accessible_svg(file, figure)
                                     : with_fixed_time(std::move(file));
}

}  // namespace

std::string draw_figure(const Figure& figure, FigureFormat format) {
  GnuplotProcess process = start_drawing(figure, format);
  return finish_drawing(process, figure, format);
}

std::vector<std::string> draw_figures(std::span<const Figure> figures, FigureFormat format) {
  std::vector<std::string> files;
  for (std::size_t first = 0; first < figures.size(); first += kMaxProcesses) {
    const auto batch = figures.subspan(first, std::min(kMaxProcesses, figures.size() - first));
    std::vector<GnuplotProcess> processes;
    processes.reserve(batch.size());
    for (const Figure& figure : batch) processes.push_back(start_drawing(figure, format));
    for (std::size_t i = 0; i < batch.size(); ++i) {
      files.push_back(finish_drawing(processes[i], batch[i], format));
    }
  }
  return files;
}

}  // namespace touchtrial::analysis
