/// \file Numbers as text in a report's tables and sentences: with typographic minus signs, a
/// decimal dot in every locale, and "–" for a number that does not exist or is not finite.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

inline constexpr const char* kNoFigure = "–";

/// "77.0%" of 0.77
[[nodiscard]] std::string share_figure(std::optional<double> share);
/// "[73.1, 80.9]" of 0.731 to 0.809: per cent, or percentage points for a difference.
[[nodiscard]] std::string share_range(const std::optional<Interval>& interval);
/// "+7.5" of 0.075, in percentage points
[[nodiscard]] std::string points_figure(std::optional<double> difference);
/// With fixed decimals, and a sign only if the number is negative.
[[nodiscard]] std::string plain_figure(std::optional<double> figure, int decimals);
[[nodiscard]] std::string plain_range(const std::optional<Interval>& interval, int decimals);
/// With its sign; "0.0" without a sign if it rounds to that.
[[nodiscard]] std::string signed_plain_figure(std::optional<double> figure, int decimals);
/// "0.023", "< 0.001"
[[nodiscard]] std::string p_figure(std::optional<double> p);
/// "p = 0.023", "p < 0.001"
[[nodiscard]] std::string p_phrase(double p);
/// "a", "a and b", "a, b and c"
[[nodiscard]] std::string listed(const std::vector<std::string>& names);
/// A name reduced to lower-case letters, digits and single hyphens, for ids and file names; may be
/// empty.
[[nodiscard]] std::string slug_of(const std::string& name);

}  // namespace touchtrial::analysis
