/// \file Numbers as text, with a decimal point in every locale, and "-" for a missing number.
#pragma once

#include "analysis/statistics/proportion.hpp"
#include "core/text.hpp"

#include <optional>
#include <string>

namespace touchtrial::analysis {

/// "87.5%" for 87.5
[[nodiscard]] std::string percent(std::optional<double> percentage, int decimals);
/// "87.5%" for 0.875
[[nodiscard]] std::string percent_of_share(std::optional<double> share);
[[nodiscard]] std::string percent_of(const Proportion& proportion);

/// A number with its sign; zero has none.
[[nodiscard]] std::string signed_figure(std::optional<double> figure, int decimals);
/// Three significant digits, never "0".
[[nodiscard]] std::string p_value(double p);

using touchtrial::counted;

/// A table's title after an empty line, with a stamp if its numbers are simulated.
[[nodiscard]] std::string heading(const std::string& title, bool simulated);
/// The line that begins and ends every text with simulated numbers; empty if they are not
/// simulated.
[[nodiscard]] std::string simulated_line(bool simulated);

}  // namespace touchtrial::analysis
