#include "analysis/outcomes/collection.hpp"

#include "analysis/outcomes/collection_records.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "analysis/report/text_figures.hpp"
#include "record/payload_json.hpp"
#include "study/deviation_codes.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace touchtrial::analysis {
namespace {

/// The row of an erased session, without data about the participant.
record::SessionRow anonymous_row(const record::SessionRow& row) {
  record::SessionRow anonymous;
  anonymous.session = row.session;
  anonymous.state = row.state;
  anonymous.withdrawn = true;
  anonymous.erased = true;
  return anonymous;
}

std::map<int, SessionRecord> empty_records(const std::vector<record::SessionRow>& rows) {
  std::map<int, SessionRecord> records;
  for (const record::SessionRow& row : rows) {
    records[row.session].row = row.erased ? anonymous_row(row) : row;
  }
  return records;
}

void count_hand(const record::TrialRow& trial, HandCounts& outside) {
  if (!trial.has_trace()) return;
  ++outside.trials;
  outside.contact += trial.hand.contact ? 0 : 1;
  outside.path += trial.hand.path ? 0 : 1;
  outside.force += trial.hand.force ? 0 : 1;
  outside.speed += trial.hand.speed ? 0 : 1;
}

bool is_practice_failure(const Deviation& deviation) {
  return deviation.code == "practice-not-passed";
}

/// Sets the values that depend on all events of a session.
void complete_record(SessionRecord& record) {
  if (record.practice) {
    record.practice->passed = std::ranges::none_of(record.deviations, is_practice_failure);
  }
  // A stop is dropped if the session was resumed afterwards.
  if (record.row.state != record::SessionState::stopped) record.stop_reason.clear();
}

/// \return nothing without times
std::optional<double> median_in_tenths(std::vector<double> times_s) {
  if (times_s.empty()) return std::nullopt;
  std::ranges::sort(times_s);
  const std::size_t half = times_s.size() / 2;
  const bool is_odd = times_s.size() % 2 == 1;
  return record::in_tenths(is_odd ? times_s[half] : (times_s[half - 1] + times_s[half]) / 2.0);
}

}  // namespace

std::optional<AnswerSpread> spread_of(std::vector<record::TrialRow> trials) {
  std::erase_if(trials, [](const record::TrialRow& trial) { return !position_of(trial.answer); });
  if (trials.empty()) return std::nullopt;
  std::ranges::sort(trials, {}, &record::TrialRow::answered_at);
  AnswerSpread spread;
  std::map<int, int> counts;
  int max_count = 0;
  int run = 0;
  std::vector<double> times_s;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    max_count = std::max(max_count, ++counts[*position_of(trials[i].answer)]);
    run = i > 0 && position_of(trials[i].answer) == position_of(trials[i - 1].answer) ? run + 1 : 1;
    spread.longest_run = std::max(spread.longest_run, run);
    const auto time = trials[i].reaction_time();
    if (time) times_s.push_back(std::chrono::duration<double>(*time).count());
  }
  spread.different = static_cast<int>(counts.size());
  spread.largest_share = static_cast<double>(max_count) / static_cast<double>(trials.size());
  spread.median_s = median_in_tenths(std::move(times_s));
  return spread;
}

std::optional<CollectionDates> dates_of(const std::vector<SessionRecord>& sessions) {
  constexpr std::size_t kDay = 10;  // "2026-01-31"
  std::optional<CollectionDates> dates;
  for (const SessionRecord& one : sessions) {
    if (one.row.erased || one.opened_utc.size() < kDay) continue;
    const std::string day = one.opened_utc.substr(0, kDay);
    if (!dates) dates = {day, day};
    dates = {std::min(dates->first, day), std::max(dates->last, day)};
  }
  return dates;
}

bool ran_unverified(const SessionRecord& session) {
  return (session.station && session.station->calibration == study::kUnverifiedDevice) ||
         std::ranges::find(session.deviations, study::kUnverifiedDeviceCode, &Deviation::code) !=
             session.deviations.end();
}

bool any_ran_unverified(const std::vector<SessionRecord>& sessions) {
  return std::ranges::any_of(sessions, [](const SessionRecord& session) {
    return !session.row.erased && ran_unverified(session);
  });
}

std::string simulated_devices(const std::vector<record::SessionRow>& sessions) {
  std::set<std::string> recorded;
  for (const record::SessionRow& session : sessions) {
    if (session.simulated && !session.erased) recorded.insert(session.device);
  }
  return device_words(recorded);
}

std::string simulated_devices(const Collection& collection) {
  std::vector<record::SessionRow> rows;
  for (const SessionRecord& session : collection.sessions) rows.push_back(session.row);
  return simulated_devices(rows);
}

Collection load_collection(const StudyEvents& study, const SessionKeys& keys) {
  const record::StudyStore& store = study.store();
  const std::vector<record::SessionRow> rows = store.sessions();
  std::map<int, SessionRecord> records = empty_records(rows);
  Collection collection;
  collection.prescription = prescription_from_json(store.commitment().configuration);
  const auto add = [&](const record::Event& event) {
    const auto record = records.find(record::session_about(event));
    if (record == records.end() || record->second.row.erased) return;
    const auto key = keys.find(record->first);
    const bool can_open = key != keys.end() && is_partly_sealed(event.kind);
    add_to_record(can_open ? readable_event(event, record->second.row, key->second) : event,
                  record->second);
    if (event.kind != record::EventKind::trace_stored) return;
    if (const auto servo = servo_trial_of(event)) collection.servo_trials.push_back(*servo);
  };
  study.for_each_of(collection_event_kinds(), add);
  for (const record::Event& event : store.events(0)) add(event);  // notes made afterwards
  for (const record::TrialRow& trial : store.trials()) {
    const auto record = records.find(trial.session);
    if (record == records.end() || record->second.row.withdrawn) continue;
    count_hand(trial, record->second.outside);
  }
  for (auto& [session, record] : records) {
    complete_record(record);
    collection.visual = collection.visual || (record.station && record.station->visual);
    collection.sessions.push_back(std::move(record));
  }
  const record::StudyState state = store.state();
  collection.looks = state.looks;
  collection.flow = participant_flow(rows, collection.sessions, store.commitment(), state);
  return collection;
}

}  // namespace touchtrial::analysis
