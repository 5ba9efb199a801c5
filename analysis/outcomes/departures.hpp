/// \file Departures from the registration: looks, numbers of participants, excluded sessions, and
/// deviations. Source: docs/statistics.md, "The registered question".
#pragma once

#include "analysis/outcomes/outcomes.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The sessions that a registered rule excludes, each with a description of the first such rule.
[[nodiscard]] std::map<int, std::string> met_exclusion_rules(const Outcomes& outcomes);

/// The sessions with more missed catch trials than the registered rule allows. Because only
/// outcomes show this, the analysis omits them even if the experimenter did not exclude them.
[[nodiscard]] std::set<int> sessions_with_missed_catches(const Outcomes& outcomes);

/// Every departure from the registration, in one or two sentences each, the most serious first.
/// \param ended_at_look  as in PrimaryResult; if set, stopping early is not a departure
[[nodiscard]] std::vector<std::string> departures_of(const Outcomes& outcomes,
                                                     bool ended_at_look = false);

/// \return "p is not adjusted for 2 unregistered looks at outcomes."; empty without such looks
[[nodiscard]] std::string unadjusted_words(const std::vector<Look>& looks);

}  // namespace touchtrial::analysis
