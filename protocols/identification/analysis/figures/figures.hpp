/// \file The figures of a study's report.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/identification/analysis/cues/cue_report.hpp"
#include "protocols/identification/analysis/cues/exploration_path.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

struct FigureOptions {
  /// Shows the source paper's accuracies as open marks. They belong to other images and another
  /// device, so they have a column of their own unless a class has the name of the paper's image.
  bool paper_values = false;
  const CueReport* cues = nullptr;                  ///< not owned; null: no ideal observers
  std::span<const ExplorationPath> explorations{};  ///< one figure for each, drawn last
  std::string stamp{};  ///< on every figure besides SIMULATED, for instance "INTERIM LOOK"
};

/// The figures that have something to show, in the order of a results section; a study without
/// counted trials has hardly any. Their scripts contain all data, and no figure is drawn yet. Cost:
/// milliseconds. Thread-safe.
[[nodiscard]] std::vector<Figure> report_figures(const StudyReport& report,
                                                 const FigureOptions& options = {});

}  // namespace touchtrial::analysis::identification
