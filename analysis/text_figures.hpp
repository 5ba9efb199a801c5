/// \file How figures stand in text: with a decimal dot whatever the locale, "-" where there is
/// none.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace touchtrial::analysis {

/// "87.5%" of 87.5
[[nodiscard]] std::string percent(std::optional<double> percentage, int decimals);
/// "87.5%" of 0.875
[[nodiscard]] std::string percent_of_share(std::optional<double> share);
[[nodiscard]] std::string percent_of(const Proportion& proportion);
/// "[60.9, 91.1]" of 0.609 to 0.911
[[nodiscard]] std::string percent_range(const Interval& interval);
/// The same, or "-" where there is none.
[[nodiscard]] std::string percent_range(const std::optional<Interval>& interval);

/// "+7.5" of 0.075: percentage points, with their sign.
[[nodiscard]] std::string points(double difference);
/// An interval of such differences: "[-1.0, +3.5]", or "-" where there is none.
[[nodiscard]] std::string points_range(const std::optional<Interval>& interval);
/// With its sign.
[[nodiscard]] std::string signed_figure(std::optional<double> figure, int decimals);
/// Three significant digits, never "0".
[[nodiscard]] std::string p_value(double p);

/// "1 session", "3 sessions"
[[nodiscard]] std::string counted(std::int64_t n, const std::string& noun);

/// A table's title after an empty line, stamped if its figures are simulated.
[[nodiscard]] std::string heading(const std::string& title, bool simulated);
/// The line that begins and ends whatever is simulated; nothing otherwise.
[[nodiscard]] std::string simulated_line(bool simulated);

}  // namespace touchtrial::analysis
