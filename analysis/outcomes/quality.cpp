#include "analysis/outcomes/quality.hpp"

#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/collection_records.hpp"
#include "analysis/report/json_figures.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/statistics/confusion.hpp"
#include "analysis/verification/chain_notes.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {

namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void add_trial(const record::ServoHealth& trial, ServoQuality& quality) {
  quality.lowest_rate_hz =
      quality.trials == 0 ? trial.rate_hz : std::min(quality.lowest_rate_hz, trial.rate_hz);
  quality.highest_p99_us = std::max(quality.highest_p99_us, trial.lateness_p99_us);
  quality.worst_us = std::max(quality.worst_us, trial.lateness_worst_us);
  quality.lost += trial.lost;
  ++quality.trials;
}

std::optional<ServoQuality> servo_quality(const Collection& collection) {
  if (collection.servo_trials.empty()) return std::nullopt;
  ServoQuality quality;
  std::vector<double> p99_us;
  for (const ServoTrial& trial : collection.servo_trials) {
    add_trial(trial.health, quality);
    p99_us.push_back(trial.health.lateness_p99_us);
  }
  quality.median_p99_us = median_of(std::move(p99_us));
  std::set<std::string> scheduling;
  for (const SessionRecord& session : collection.sessions) {
    if (session.station) scheduling.insert(session.station->scheduling);
  }
  quality.scheduling.assign(scheduling.begin(), scheduling.end());
  return quality;
}

void count_session(const record::SessionRow& session, const record::StudyCommitment& commitment,
                   SessionCounts& counts) {
  if (session.pilot && !commitment.pilot) ++counts.pilot;
  if (session.withdrawn) ++counts.withdrawn;
  if (session.erased) {
    ++counts.erased;
  } else if (!session.replaced_by.empty()) {
    ++counts.replaced;
  } else if (session.excluded) {
    ++counts.excluded;
  } else if (session.state == record::SessionState::completed) {
    ++counts.completed;
  } else if (session.state == record::SessionState::stopped) {
    ++counts.stopped;
  } else {
    ++counts.open;
  }
}

void count_answer(const record::TrialRow& trial, TrialQuality& quality) {
  ++quality.presented;
  if (trial.state == record::TrialState::timed_out) ++quality.no_response;
  if (trial.state == record::TrialState::interrupted) ++quality.not_repeated;
  if (trial.state != record::TrialState::answered) return;
  ++quality.answered;
  if (trial.paused) ++quality.paused;
}

void count_trace(const record::TrialRow& trial, TrialQuality& quality) {
  if (!trial.has_trace()) return;
  ++quality.with_trace;
  if (trial.valid) ++quality.valid;
  quality.overruns += trial.overruns;
  if (trial.overruns > 0) ++quality.with_overruns;
  quality.lowest_rate_hz = std::min(quality.lowest_rate_hz.value_or(trial.rate_hz), trial.rate_hz);
}

void put_real_time(nlohmann::ordered_json& object, const ServoQuality& servo) {
  object["trials_in_real_time"] = servo.trials;
  object["lowest_rate_had_hz"] = servo.lowest_rate_hz;
  object["lateness_us"] = {{"median_p99", servo.median_p99_us},
                           {"highest_p99", servo.highest_p99_us},
                           {"worst", servo.worst_us}};
  object["lost_samples"] = servo.lost;
  object["scheduling"] = servo.scheduling;
}

/// For each session, the numbers of trials in which the hand left each window.
nlohmann::ordered_json hands_json(const Collection& collection) {
  auto hands = nlohmann::ordered_json::array();
  for (const SessionRecord& session : collection.sessions) {
    const HandCounts& outside = session.outside;
    if (outside.trials == 0) continue;
    hands.push_back({{"session", session.row.session},
                     {"trials", outside.trials},
                     {"contact", outside.contact},
                     {"path", outside.path},
                     {"force", outside.force},
                     {"speed", outside.speed}});
  }
  return hands;
}

}  // namespace

std::string name_of(const record::StudyState& state) {
  if (state.unblinded) return "unblinded";
  return state.closed ? "closed" : "collecting";
}

QualityReport make_quality(const record::StudyStore& store) {
  const record::StudyCommitment& commitment = store.commitment();
  QualityReport report;
  report.study = commitment.study;
  report.protocol = commitment.protocol;
  report.state = store.state();
  report.simulated = commitment.simulated;
  report.pilot = commitment.pilot;
  const Prescription prescription = prescription_from_json(commitment.configuration);
  std::set<int> erased;
  for (const record::SessionRow& session : store.sessions()) {
    count_session(session, commitment, report.sessions);
    if (session.erased) erased.insert(session.session);
    const bool is_last = session.visit == prescription.visits;
    if (session_counts(session, commitment) && is_last) ++report.participants;
  }
  report.trials = report.participants * commitment.scored_trials;
  for (const record::TrialRow& trial : store.trials()) {
    if (erased.contains(trial.session)) continue;
    count_answer(trial, report.quality);
    count_trace(trial, report.quality);
  }
  report.collection = load_collection(store);
  for (const SessionRecord& session : report.collection.sessions) {
    report.quality.interrupted += session.interruptions;
  }
  report.servo = servo_quality(report.collection);
  report.visual = report.collection.visual;
  report.notes = chain_notes(store);
  if (!prescription.draft.empty()) report.notes.push_back(prescription.draft);
  return report;
}

nlohmann::ordered_json quality_object(const QualityReport& report) {
  const SessionCounts& sessions = report.sessions;
  const TrialQuality& quality = report.quality;
  nlohmann::ordered_json object{{"study", report.study}, {"protocol", report.protocol}};
  put_stamp(object, report.simulated, simulated_devices(report.collection));
  object["unverified_device"] = !report.simulated && any_ran_unverified(report.collection.sessions);
  put_state(object, report.state, report.pilot);
  object["blinded"] = !report.state.unblinded;
  object["participants"] = report.participants;
  object["trials"] = report.trials;
  object["sessions"] = {{"completed", sessions.completed}, {"open", sessions.open},
                        {"stopped", sessions.stopped},     {"excluded", sessions.excluded},
                        {"replaced", sessions.replaced},   {"erased", sessions.erased},
                        {"withdrawn", sessions.withdrawn}, {"pilot", sessions.pilot}};
  object["responses"] = {
      {"presented", quality.presented},     {"answered", quality.answered},
      {"no_response", quality.no_response}, {"paused", quality.paused},
      {"interrupted", quality.interrupted}, {"not_repeated", quality.not_repeated}};
  object["validity"] = {
      {"trials", quality.with_trace},
      {"valid", quality.valid},
      {"share", figure_json(Proportion{quality.with_trace, quality.valid}.share())}};
  object["servo"] = {{"overruns", quality.overruns},
                     {"trials_with_overruns", quality.with_overruns},
                     {"lowest_rate_hz", figure_json(quality.lowest_rate_hz)}};
  if (report.servo) put_real_time(object["servo"], *report.servo);
  object["outside"] = hands_json(report.collection);
  if (report.visual) object["visual"] = true;
  object["collection"] = collection_object(report.collection);
  if (!report.notes.empty()) object["notes"] = report.notes;
  return object;
}

std::string quality_json(const QualityReport& report) {
  return json_text(quality_object(report));
}

}  // namespace touchtrial::analysis
