/// \file Thresholds of detection that pilots had. Source: docs/perception.md, "Pilots".
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::planning::threshold {

/// \param report  of the pilots' study, as `report --json` prints it
/// \param place  with which an error begins
/// \return as Planner::pilot_thresholds; nothing if the study is no detection study along gain that
///   asks which interval
/// \throws StudyError if there are too few thresholds
[[nodiscard]] std::optional<std::vector<std::pair<std::string, double>>> pilot_means(
    const std::string& report, const std::string& place);

}  // namespace touchtrial::planning::threshold
