/// \file How cues stand in JSON. Not for public headers: it shows the JSON library.
/// Format: docs/data-dictionary.md, "Cues".
#pragma once

#include "analysis/cues/cue_report.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {

/// What stands under "cues" in the report; stamped if simulated. Each kind of figure is named once,
/// under "by". Figures that do not exist are null.
[[nodiscard]] nlohmann::ordered_json cues_object(const CueReport& report);

}  // namespace touchtrial::analysis
