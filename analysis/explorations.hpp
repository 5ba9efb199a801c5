/// \file How hands explored what they felt: times, forces and speeds over the counted trials.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The counted trials of one method, each with the same weight. Contact, path, force and speed are
/// of the trials with a trace that touched the plane.
struct Explorations {
  std::string method;
  int trials = 0;
  int without_response = 0;  ///< the time ran out
  Quartiles answer_s;        ///< from the moment the plane can be felt to the answer
  Quartiles contact_s;       ///< at the plane
  Quartiles path_mm;         ///< along the plane, while in contact
  Quartiles speed_mm_s;      ///< path over contact
  Quartiles force_n;         ///< root mean square over the contact
  Quartiles saturated;       ///< share of the contact with the force at its limit, 0 .. 1
};

/// One entry for each method, in the order of Outcomes::methods.
[[nodiscard]] std::vector<Explorations> explorations_of(const Outcomes& outcomes);

}  // namespace touchtrial::analysis
