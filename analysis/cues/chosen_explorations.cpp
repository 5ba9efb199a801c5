#include "analysis/cues/chosen_explorations.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

const TrialOutcome* trial_named(const Outcomes& outcomes, const TrialName& name) {
  const TrialOutcome* found = nullptr;
  for (const TrialOutcome& one : outcomes.trials) {
    const bool fits =
        one.scored && one.participant == name.participant && one.row.trial == name.trial;
    if (fits && (found == nullptr || (one.counted && !found->counted))) found = &one;
  }
  return found;
}

}  // namespace

TrialName trial_name(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon > 0) {
    TrialName name{text.substr(0, colon), 0};
    const char* end = text.data() + text.size();
    const auto [rest, fault] = std::from_chars(text.data() + colon + 1, end, name.trial);
    if (fault == std::errc() && rest == end && name.trial > 0) return name;
  }
  throw UsageError(one_line(text) +
                   ": is no trial's name; write PARTICIPANT:N, as P01:3 for P01's third trial");
}

ExplorationPath exploration_named(const store::StudyStore& store, const design::StudyKey& key,
                                  const Outcomes& outcomes, const TrialName& name) {
  const TrialOutcome* trial = trial_named(outcomes, name);
  if (trial == nullptr) {
    throw UsageError(fmt::format(
        "{}:{}: the study holds no such scored trial; choose one that `touchtrial export` lists",
        one_line(name.participant), name.trial));
  }
  return exploration_path(store, key, outcomes, trial->row.session, trial->row.trial);
}

std::vector<ExplorationPath> first_explorations(const store::StudyStore& store,
                                                const design::StudyKey& key,
                                                const Outcomes& outcomes) {
  std::vector<ExplorationPath> paths;
  for (int method = 0; method < static_cast<int>(outcomes.methods.size()); ++method) {
    const auto first = std::ranges::find_if(outcomes.trials, [&](const TrialOutcome& one) {
      return one.counted && one.stimulus.method == method &&
             store.sealed_trace(one.row.session, one.row.trial).has_value();
    });
    if (first == outcomes.trials.end()) continue;
    paths.push_back(exploration_path(store, key, outcomes, first->row.session, first->row.trial));
  }
  return paths;
}

}  // namespace touchtrial::analysis
