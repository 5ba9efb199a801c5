/// \file Words for simulated numbers and their device, and p values with three digits.
#pragma once

#include "core/text.hpp"

#include <set>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Three significant digits, never "0".
[[nodiscard]] std::string p_value(double p);

using touchtrial::counted;

/// Adds "3 excluded" if there are such people.
void add_people(int people, const char* words, std::vector<std::string>& all);

/// A table's title after an empty line, with a stamp if its numbers are simulated.
[[nodiscard]] std::string heading(const std::string& title, bool simulated);
/// The simulated devices: "modelled device touch", or "ideal device (no such device is sold)".
/// \param recorded  record::SessionRow::device, or kStatedPeople; may be empty
[[nodiscard]] std::string device_words(const std::set<std::string>& recorded);
/// Replaces a recorded device if people's accuracies are stated.
inline constexpr const char* kStatedPeople = "stated";
/// "simulated on: modelled device touch", or empty
/// \param device  device_words
[[nodiscard]] std::string simulated_on(const std::string& device);
[[nodiscard]] std::string simulated_on_line(const std::string& device);

/// The first and last line of texts with simulated numbers; empty if they are not simulated.
[[nodiscard]] std::string simulated_line(bool simulated);

}  // namespace touchtrial::analysis
