/// \file Axes of threshold figures.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <string>

namespace touchtrial::analysis::threshold {

/// The room beyond the first and the last level on an axis, dB.
[[nodiscard]] double room_at_ends(const ThresholdReport& report);
/// "level, dB re the pack's gain"
[[nodiscard]] std::string unit_label(const ThresholdReport& report);
/// All levels, with room_at_ends.
[[nodiscard]] Axis level_axis(const ThresholdReport& report);
/// "bark, -12 dB" for "bark, standard -12 dB"
[[nodiscard]] std::string short_name(const StandardReport& standard);

}  // namespace touchtrial::analysis::threshold
