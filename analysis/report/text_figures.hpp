/// \file Words about simulated numbers and their device, and p values with all their digits.
#pragma once

#include "core/text.hpp"

#include <set>
#include <string>

namespace touchtrial::analysis {

/// Three significant digits, never "0".
[[nodiscard]] std::string p_value(double p);

using touchtrial::counted;

/// A table's title after an empty line, with a stamp if its numbers are simulated.
[[nodiscard]] std::string heading(const std::string& title, bool simulated);
/// The device that simulated numbers hold for, for people: "modelled device touch", or "ideal
/// device (no such device is sold)". Several are joined.
/// \param recorded  as sessions record their device (record::SessionRow), or kStatedPeople
/// \return empty for none
[[nodiscard]] std::string device_words(const std::set<std::string>& recorded);
/// In place of a recorded device if people's accuracies are stated.
inline constexpr const char* kStatedPeople = "stated";
/// What is said first of simulated numbers: "simulated on: modelled device touch"; empty for none.
/// \param device  device_words
[[nodiscard]] std::string simulated_on(const std::string& device);
/// The same as a line.
[[nodiscard]] std::string simulated_on_line(const std::string& device);

/// The line that begins and ends every text with simulated numbers; empty if they are not
/// simulated.
[[nodiscard]] std::string simulated_line(bool simulated);

}  // namespace touchtrial::analysis
