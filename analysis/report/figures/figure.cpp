#include "analysis/report/figures/figure.hpp"

#include "analysis/report/figures/gnuplot.hpp"
#include "analysis/report/figures/gnuplot_script.hpp"
#include "analysis/report/figures/svg.hpp"
#include "core/errors.hpp"

#include <algorithm>

namespace touchtrial::analysis {
namespace {

/// Processes at the same time; more would only take memory.
constexpr std::size_t kAtOnce = 8;

/// Replaces the time that cairo writes, so that the same figure is the same file. From 1.18 on
/// cairo compresses it together with what else it writes there: such a file keeps its time
/// (docs/report.md).
std::string without_time(std::string pdf) {
  static constexpr std::string_view kBefore = "/CreationDate (D:";
  static constexpr std::string_view kEpoch = "19700101000000";
  const std::size_t at = pdf.find(kBefore);
  if (at != std::string::npos && at + kBefore.size() + kEpoch.size() <= pdf.size()) {
    pdf.replace(at + kBefore.size(), kEpoch.size(), kEpoch);
  }
  return pdf;
}

GnuplotProcess started(const Figure& figure, FigureFormat format) {
  const Layout layout = layout_of(figure);
  return {"", gnuplot_terminal(figure, layout, format) + gnuplot_script(figure, layout)};
}

std::string finished(GnuplotProcess& process, const Figure& figure, FigureFormat format) {
  std::string file = process.result();
  if (file.empty()) {
    throw Error("figure " + figure.id + ": gnuplot drew nothing" + gnuplot_remedy());
  }
  return format == FigureFormat::svg ? accessible_svg(file, figure) : without_time(std::move(file));
}

}  // namespace

std::string drawn(const Figure& figure, FigureFormat format) {
  GnuplotProcess process = started(figure, format);
  return finished(process, figure, format);
}

std::vector<std::string> all_drawn(std::span<const Figure> figures, FigureFormat format) {
  std::vector<std::string> files;
  for (std::size_t first = 0; first < figures.size(); first += kAtOnce) {
    const auto batch = figures.subspan(first, std::min(kAtOnce, figures.size() - first));
    std::vector<GnuplotProcess> processes;
    processes.reserve(batch.size());
    for (const Figure& figure : batch) processes.push_back(started(figure, format));
    for (std::size_t i = 0; i < batch.size(); ++i) {
      files.push_back(finished(processes[i], batch[i], format));
    }
  }
  return files;
}

}  // namespace touchtrial::analysis
