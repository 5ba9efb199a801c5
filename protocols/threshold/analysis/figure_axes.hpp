/// \file The axes that figures of thresholds share.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <string>

namespace touchtrial::analysis::threshold {

/// Of an axis of levels, beyond its ends.
[[nodiscard]] double room_at_ends(const ThresholdReport& report);
/// "level, dB re the pack's gain"
[[nodiscard]] std::string unit_label(const ThresholdReport& report);
/// All levels, with that room.
[[nodiscard]] Axis level_axis(const ThresholdReport& report);
/// "bark, -12 dB" for "bark, standard -12 dB"
[[nodiscard]] std::string short_name(const StandardReport& standard);

}  // namespace touchtrial::analysis::threshold
