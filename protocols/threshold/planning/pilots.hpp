/// \file Thresholds of detection that pilots had. Source: docs/perception.md, "Pilots".
#pragma once

#include "protocols/threshold/analysis/report.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::planning::threshold {

/// \param report  of the pilots' study
/// \param place  with which an error begins
/// \return as Planner::pilot_thresholds; nothing if the study is no detection study along gain that
///   asks which interval
/// \throws StudyError if there are too few thresholds
[[nodiscard]] std::optional<std::vector<std::pair<std::string, double>>> pilot_means(
    const analysis::threshold::ThresholdReport& report, const std::string& place);

}  // namespace touchtrial::planning::threshold
