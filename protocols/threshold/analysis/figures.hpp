/// \file Figures of threshold reports.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

/// All figures with data, in the order of a results section, not yet drawn.
/// \param stamp  on every figure in addition to SIMULATED; may be empty
[[nodiscard]] std::vector<Figure> report_figures(const ThresholdReport& report,
                                                 const std::string& stamp);

/// Each participant's threshold with its interval, and the mean, one panel per standard.
[[nodiscard]] std::optional<Figure> thresholds_figure(const ThresholdReport& report);
/// Each participant's function and their mean, one panel per standard; and observed against
/// expected right answers.
[[nodiscard]] std::optional<Figure> functions_figure(const ThresholdReport& report);
/// Levels by trial with right and wrong answers; only the first tracks of large studies.
[[nodiscard]] std::optional<Figure> tracks_figure(const ThresholdReport& report);
/// d' of same or different by level.
[[nodiscard]] std::optional<Figure> d_prime_figure(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
