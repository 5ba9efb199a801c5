/// \file The figures of a threshold study's report.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

/// The figures that have something to show, in the order of a results section. Their scripts
/// contain all data, and no figure is drawn yet.
/// \param stamp  on every figure besides SIMULATED; may be empty
[[nodiscard]] std::vector<Figure> report_figures(const ThresholdReport& report,
                                                 const std::string& stamp);

/// Participants' thresholds by standard, their mean and its interval.
[[nodiscard]] std::optional<Figure> thresholds_figure(const ThresholdReport& report);
/// Shares of right answers by level, and the functions that were fitted, one panel a standard.
[[nodiscard]] std::optional<Figure> functions_figure(const ThresholdReport& report);
/// Levels by trial, right and wrong answers marked; the first tracks of a study with many.
[[nodiscard]] std::optional<Figure> tracks_figure(const ThresholdReport& report);
/// d' of same or different by level.
[[nodiscard]] std::optional<Figure> d_prime_figure(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
