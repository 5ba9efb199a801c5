/// \file How a power run's figures are said. Private to analysis/planning.
#pragma once

#include "analysis/planning/power_report.hpp"

#include <string>
#include <vector>

namespace touchtrial::planning {

/// What everything from a power run is stamped with.
inline constexpr const char* kPowerStamp = "SIMULATED: power given the assumed sensitivity";

/// "84.3", in per cent.
[[nodiscard]] std::string power_per_cent(double share);
/// "[80.9, 87.3]", in per cent.
[[nodiscard]] std::string power_range(const analysis::Interval& interval);
/// One sentence a target.
[[nodiscard]] std::vector<std::string> target_sentences(const PowerReport& report);
/// How the figures were had, one sentence or more each.
[[nodiscard]] std::vector<std::string> method_sentences(const PowerReport& report);

}  // namespace touchtrial::planning
