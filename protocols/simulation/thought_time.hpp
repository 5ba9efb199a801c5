/// \file The thinking time of a decision. Source: docs/planning.md, "Response times".
#pragma once

#include "core/random.hpp"
#include "protocols/simulation/subject_changes.hpp"

#include <span>

namespace touchtrial::simulation {

/// The difference between the two largest supports; infinite if there is only one.
/// \param support  log odds by picture
[[nodiscard]] double margin_of(std::span<const double> support);

/// Draws a thinking time, with one standard normal number.
/// \param margin  log odds, >= 0
/// \return seconds from shift_s to max_s
[[nodiscard]] double thought_time_s(const ThoughtTime& thought, double margin,
                                    RandomStream& random);

}  // namespace touchtrial::simulation
