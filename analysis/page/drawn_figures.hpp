/// \file The figures of a report as parts of its page and as files beside it.
#pragma once

#include "analysis/figures/figure.hpp"
#include "analysis/page/report_folder.hpp"
#include "analysis/page/study_document.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

struct DrawnFigures {
  Pictures pictures;
  ReportFiles files;    ///< "figures/<id>.svg" and ".pdf"
  std::string missing;  ///< why nothing could be drawn, one line; empty: all is drawn
};

/// Without gnuplot the pictures have their words alone, and there is no file.
/// \throws Error if gnuplot is there and refuses a figure
[[nodiscard]] DrawnFigures draw_report_figures(const std::vector<Figure>& figures);

}  // namespace touchtrial::analysis
