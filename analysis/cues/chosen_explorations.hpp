/// \file Which trials' explorations a report draws.
#pragma once

#include "analysis/cues/exploration_path.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A trial as its user names it.
struct TrialName {
  std::string participant;
  int trial = 0;  ///< from 1, among all of the session's
};

/// "P01:12"; a participant's name may hold colons.
/// \throws UsageError if it is nothing of the kind
[[nodiscard]] TrialName trial_name(const std::string& text);

/// The scored trial of that name; of the session that counts, if a participant has several.
/// \throws UsageError if there is none
/// \throws StoreError if it has no trace
/// \throws VerificationError if the trace does not open
[[nodiscard]] ExplorationPath exploration_named(const store::StudyStore& store,
                                                const design::StudyKey& key,
                                                const Outcomes& outcomes, const TrialName& name);

/// Of each method the first counted trial that has a trace, in the order of sessions and trials:
/// nobody chose it by what it shows.
/// \throws VerificationError if a trace does not open
[[nodiscard]] std::vector<ExplorationPath> first_explorations(const store::StudyStore& store,
                                                              const design::StudyKey& key,
                                                              const Outcomes& outcomes);

}  // namespace touchtrial::analysis
