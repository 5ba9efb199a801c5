#include "analysis/report/reaction_times.hpp"

#include <algorithm>
#include <chrono>

namespace touchtrial::analysis {
namespace {

double seconds_between(std::chrono::nanoseconds from, std::chrono::nanoseconds to) {
  return std::chrono::duration<double>(to - from).count();
}

/// What has been collected of one class.
struct Times {
  std::vector<double> from_plane_on;
  std::vector<double> from_contact;

  void add(const store::TrialRow& row) {
    from_plane_on.push_back(seconds_between(row.presented_at, *row.answered_at));
    if (row.contact_at) from_contact.push_back(seconds_between(*row.contact_at, *row.answered_at));
  }
};

ReactionTimes summary_of(Times times) {
  std::ranges::sort(times.from_plane_on);
  return {quartiles(times.from_plane_on), quartiles(std::move(times.from_contact)),
          times.from_plane_on};
}

}  // namespace

std::vector<ReactionTimes> reaction_times(const Outcomes& outcomes, int method) {
  std::vector<Times> times(outcomes.classes.size() + 1);
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool asked = trial.counted && trial.stimulus.method == method;
    if (!asked || !trial.response || !trial.row.answered_at) continue;
    times[trial.stimulus.class_index].add(trial.row);
    times.back().add(trial.row);
  }
  std::vector<ReactionTimes> all;
  for (Times& of_class : times) all.push_back(summary_of(std::move(of_class)));
  return all;
}

}  // namespace touchtrial::analysis
