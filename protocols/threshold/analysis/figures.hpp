/// \file The figures of a threshold study's report.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

/// The figures that have something to show, in the order of a results section. No figure is drawn
/// yet.
/// \param stamp  on every figure besides SIMULATED; may be empty
[[nodiscard]] std::vector<Figure> report_figures(const ThresholdReport& report,
                                                 const std::string& stamp);

/// Each participant's threshold with its interval, and the mean, one panel a standard.
[[nodiscard]] std::optional<Figure> thresholds_figure(const ThresholdReport& report);
/// Each participant's function and their mean, one panel a standard; and how many answers were
/// right of those that the functions expect.
[[nodiscard]] std::optional<Figure> functions_figure(const ThresholdReport& report);
/// Levels by trial, right and wrong answers marked; the first tracks of a study with many.
[[nodiscard]] std::optional<Figure> tracks_figure(const ThresholdReport& report);
/// d' of same or different by level.
[[nodiscard]] std::optional<Figure> d_prime_figure(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
