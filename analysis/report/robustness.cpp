#include "analysis/report/robustness.hpp"

#include "analysis/report/counted_trials.hpp"

#include <map>
#include <set>

namespace touchtrial::analysis {
namespace {

constexpr TrialSubset kSubsets[] = {TrialSubset::counted, TrialSubset::answered, TrialSubset::valid,
                                    TrialSubset::with_excluded_sessions};

/// Completed sessions that do not count for no other reason than that they were excluded. Who was
/// excluded and began anew is in the figures already.
std::set<int> excluded_sessions(const Outcomes& outcomes) {
  std::set<int> excluded;
  for (const auto& [row, counted] : outcomes.sessions) {
    const bool left_out = row.excluded && !row.withdrawn && row.replaced_by != row.participant;
    const bool of_study = row.pilot == outcomes.pilot && row.simulated == outcomes.simulated;
    if (left_out && of_study && row.state == store::SessionState::completed)
      excluded.insert(row.session);
  }
  return excluded;
}

bool belongs_to(TrialSubset subset, const TrialOutcome& trial, const std::set<int>& excluded) {
  switch (subset) {
    case TrialSubset::counted:
      return trial.counted;
    case TrialSubset::answered:
      return trial.counted && trial.response.has_value();
    case TrialSubset::valid:
      return trial.counted && trial.valid();
    case TrialSubset::with_excluded_sessions:
      break;
  }
  return trial.counted ||
         (trial.scored && has_ended(trial) && excluded.contains(trial.row.session));
}

void count(Proportion& proportion, bool correct) {
  ++proportion.n;
  if (correct) ++proportion.correct;
}

}  // namespace

std::string name_of(TrialSubset subset) {
  switch (subset) {
    case TrialSubset::counted:
      return "counted";
    case TrialSubset::answered:
      return "answered";
    case TrialSubset::valid:
      return "valid";
    case TrialSubset::with_excluded_sessions:
      break;
  }
  return "with_excluded_sessions";
}

std::vector<SubsetAccuracy> robustness(const Outcomes& outcomes, int method) {
  const std::set<int> excluded = excluded_sessions(outcomes);
  std::vector<SubsetAccuracy> all;
  for (const TrialSubset subset : kSubsets) {
    SubsetAccuracy& here = all.emplace_back();
    here.subset = subset;
    std::map<int, Proportion> by_session;
    for (const TrialOutcome& trial : outcomes.trials) {
      const bool of_method = trial.scored && trial.stimulus.method == method;
      if (!of_method || !belongs_to(subset, trial, excluded)) continue;
      count(here.pooled, trial.correct());
      count(by_session[trial.row.session], trial.correct());
    }
    std::vector<double> shares;
    for (const auto& [session, own] : by_session) shares.push_back(own.share().value_or(0.0));
    here.mean = participant_mean(shares);
  }
  return all;
}

}  // namespace touchtrial::analysis
