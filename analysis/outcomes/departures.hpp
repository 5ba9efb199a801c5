/// \file Every departure from what was registered: looks, numbers, sessions left out, and deviations.
/// Docs: docs/statistics.md, "The registered question".
#pragma once

#include "analysis/outcomes/outcomes.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The sessions that a registered rule leaves out, each with the first rule that does, in words.
[[nodiscard]] std::map<int, std::string> rules_met(const Outcomes& outcomes);

/// Those of them that miss more catch trials than the registered rule allows. Only outcomes show
/// it, so the analysis leaves them out, excluded or not.
[[nodiscard]] std::set<int> with_missed_catches(const Outcomes& outcomes);

/// Every departure from the plan, one sentence or two each, the gravest first.
///
/// \param ended_at_look  PrimaryResult: then fewer participants than planned are no departure
[[nodiscard]] std::vector<std::string> departures_of(const Outcomes& outcomes,
                                                     bool ended_at_look = false);

/// \return "p is not adjusted for 2 unregistered looks at outcomes."; empty without such looks
[[nodiscard]] std::string unadjusted_words(const std::vector<Look>& looks);

}  // namespace touchtrial::analysis
