/// \file How figures stand in a report's tables and sentences: typographic minus and dashes, a
/// decimal dot whatever the locale, "–" where there is no figure or it is
/// not finite. Private to analysis/page.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

inline constexpr const char* kNoFigure = "–";

/// "77.0%" of 0.77
[[nodiscard]] std::string share_figure(std::optional<double> share);
/// "[73.1, 80.9]" of 0.731 to 0.809: in per cent, or in points where shares were subtracted.
[[nodiscard]] std::string share_range(const std::optional<Interval>& interval);
/// "+7.5" of 0.075: percentage points.
[[nodiscard]] std::string points_figure(std::optional<double> difference);
/// Fixed decimals, and a sign only where it is below zero.
[[nodiscard]] std::string plain_figure(std::optional<double> figure, int decimals);
[[nodiscard]] std::string plain_range(const std::optional<Interval>& interval, int decimals);
/// With its sign, "0.0" if it rounds to that.
[[nodiscard]] std::string signed_plain_figure(std::optional<double> figure, int decimals);
/// "0.023", "< 0.001"
[[nodiscard]] std::string p_figure(std::optional<double> p);
/// "p = 0.023", "p < 0.001"
[[nodiscard]] std::string p_phrase(double p);
/// "a", "a and b", "a, b and c"
[[nodiscard]] std::string listed(const std::vector<std::string>& names);
/// Lower-case letters, digits and single hyphens alone: for ids and file names; may be empty.
[[nodiscard]] std::string slug_of(const std::string& name);

}  // namespace touchtrial::analysis
