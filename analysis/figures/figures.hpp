/// \file The figures of a study's report: which there are, and drawing them.
#pragma once

#include "analysis/cues/cue_report.hpp"
#include "analysis/cues/exploration_path.hpp"
#include "analysis/figures/figure.hpp"
#include "analysis/report/report.hpp"

#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

struct FigureOptions {
  /// The source paper's accuracies as open marks, in a column of their own unless a class bears the
  /// name that the paper gives an image: they are of other images and another device.
  bool paper_values = false;
  const CueReport* cues = nullptr;                  ///< not owned; without it no ideal observers
  std::span<const ExplorationPath> explorations{};  ///< a figure each, drawn last
  std::string stamp{};  ///< on every figure beside SIMULATED, as "INTERIM LOOK"; empty: nothing
};

/// Those that have something to show, in the order of a results section; a study without counted
/// trials has hardly any. Their scripts hold all data.
/// Cost: milliseconds; nothing is drawn yet. Thread-safe.
[[nodiscard]] std::vector<Figure> report_figures(const StudyReport& report,
                                                 const FigureOptions& options = {});

/// The same as `drawn` of each, by several processes at the same time.
/// \throws Error as `drawn`
/// Thread-safe.
[[nodiscard]] std::vector<std::string> all_drawn(std::span<const Figure> figures,
                                                 FigureFormat format);

}  // namespace touchtrial::analysis
