/// \file Every departure from what was registered: looks, numbers, sessions left out, and deviations.
/// Docs: docs/statistics.md, "The registered question".
#pragma once

#include "analysis/outcomes/outcomes.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The sessions that a registered rule excludes, each with the first such rule in words.
[[nodiscard]] std::map<int, std::string> rules_met(const Outcomes& outcomes);

/// The sessions that miss more catch trials than the registered rule allows. Only outcomes show
/// this, so the analysis leaves them out even if the experimenter did not exclude them.
[[nodiscard]] std::set<int> with_missed_catches(const Outcomes& outcomes);

/// Every departure from the plan, in one or two sentences each, the most serious first.
///
/// \param ended_at_look  as in PrimaryResult; if set, fewer participants than planned are not a
///   departure
[[nodiscard]] std::vector<std::string> departures_of(const Outcomes& outcomes,
                                                     bool ended_at_look = false);

/// \return "p is not adjusted for 2 unregistered looks at outcomes."; empty without such looks
[[nodiscard]] std::string unadjusted_words(const std::vector<Look>& looks);

}  // namespace touchtrial::analysis
