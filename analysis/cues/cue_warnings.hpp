/// \file What a reader could take the observers' figures for, wrongly.
#pragma once

#include "analysis/cues/cue_report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// CueReport::plane_source if nothing else tells the plane's size.
inline constexpr const char* kPlaneFromTraces = "the farthest that hands had contact";

/// Sentences. \param report  but for its warnings
[[nodiscard]] std::vector<std::string> cue_warnings(const Outcomes& outcomes,
                                                    const CueReport& report);

}  // namespace touchtrial::analysis
