#include "analysis/report/quality.hpp"

#include "analysis/report/servo_quality.hpp"
#include "analysis/session_rules.hpp"

#include <algorithm>
#include <set>

namespace touchtrial::analysis {
namespace {

void count_session(const store::SessionRow& session, const store::StudyCommitment& commitment,
                   SessionCounts& counts) {
  if (session.pilot && !commitment.pilot) ++counts.pilot;
  if (session.withdrawn) {
    ++counts.withdrawn;
  } else if (!session.replaced_by.empty()) {
    ++counts.replaced;
  } else if (session.excluded) {
    ++counts.excluded;
  } else if (session.state == store::SessionState::completed) {
    ++counts.completed;
  } else if (session.state == store::SessionState::stopped) {
    ++counts.stopped;
  } else {
    ++counts.open;
  }
}

void count_answer(const store::TrialRow& trial, TrialQuality& quality) {
  ++quality.presented;
  if (trial.state == store::TrialState::timed_out) ++quality.no_response;
  if (trial.state == store::TrialState::interrupted) ++quality.interrupted;
  if (trial.state != store::TrialState::answered || !trial.position) return;
  ++quality.answered;
  if (trial.first_position && trial.first_position != trial.position) ++quality.changed;
  const int position = *trial.position;
  if (position >= 0 && position < static_cast<int>(quality.by_position.size())) {
    ++quality.by_position[position];
  }
}

void count_trace(const store::TrialRow& trial, TrialQuality& quality) {
  if (trial.samples == 0) return;
  ++quality.with_trace;
  if (trial.valid) ++quality.valid;
  quality.overruns += trial.overruns;
  if (trial.overruns > 0) ++quality.with_overruns;
  quality.lowest_rate_hz = std::min(quality.lowest_rate_hz.value_or(trial.rate_hz), trial.rate_hz);
}

}  // namespace

std::string name_of(const store::StudyState& state) {
  if (state.unblinded) return "unblinded";
  return state.closed ? "closed" : "collecting";
}

QualityReport make_quality(const store::StudyStore& store) {
  const store::StudyCommitment& commitment = store.commitment();
  QualityReport report;
  report.study = commitment.study;
  report.protocol = commitment.protocol;
  report.state = store.state();
  report.simulated = commitment.simulated;
  report.pilot = commitment.pilot;
  report.quality.by_position.resize(static_cast<std::size_t>(std::max(0, commitment.positions)));
  std::set<int> withdrawn;
  for (const store::SessionRow& session : store.sessions()) {
    count_session(session, commitment, report.sessions);
    if (session.withdrawn) withdrawn.insert(session.session);
    if (session_counts(session, commitment)) ++report.participants;
  }
  report.trials = report.participants * commitment.scored_trials;
  for (const store::TrialRow& trial : store.trials()) {
    if (withdrawn.contains(trial.session)) continue;
    count_answer(trial, report.quality);
    count_trace(trial, report.quality);
  }
  report.collection = load_collection(store);
  report.servo = servo_quality(report.collection);
  report.visual = report.collection.visual;
  return report;
}

}  // namespace touchtrial::analysis
