/// \file The report on cues as JSON. Public headers must not include this file, because it exposes
/// the JSON library. Format: docs/data-dictionary.md, "Cues".
#pragma once

#include "protocols/identification/analysis/cues/cue_report.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::analysis::identification {

/// The value of "cues" in the report, stamped if simulated. Its key "by" states the method of each
/// kind of number. Undefined numbers are null.
[[nodiscard]] nlohmann::ordered_json cues_object(const CueReport& report);

}  // namespace touchtrial::analysis::identification
