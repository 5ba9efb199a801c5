/// \file Detection thresholds from pilot studies. Source: docs/perception.md, "Pilots".
#pragma once

#include "protocols/threshold/analysis/report.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::planning::threshold {

/// The mean thresholds of a pilot study.
/// \param report  of the pilot study
/// \param place  prefix of error messages
/// \return as Planner::pilot_thresholds does; empty unless the study is a detection study along
///   gain that asks which interval had the texture
/// \throws StudyError if there are too few thresholds
[[nodiscard]] std::optional<std::vector<std::pair<std::string, double>>> pilot_means(
    const analysis::threshold::ThresholdReport& report, const std::string& place);

}  // namespace touchtrial::planning::threshold
