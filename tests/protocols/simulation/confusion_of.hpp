/// \file The participants' answers, read from a database with the study's key.
#pragma once

#include "record/study_store.hpp"
#include "study/study_key.hpp"
#include "support/as_recorded.hpp"

#include <map>
#include <utility>
#include <vector>

namespace touchtrial {

/// Counts of (presented class, answered class).
using Confusion = std::map<std::pair<int, int>, int>;

[[nodiscard]] inline SecretKey key_of_session(const record::StudyStore& store,
                                              const study::StudyKey& key, int session) {
  return record::unwrap_participant_key(key.box(), session, store.wrapped_key(session).value())
      .value();
}

[[nodiscard]] inline study::Schedule schedule_of_session(const record::StudyStore& store,
                                                         const study::StudyKey& key, int session) {
  return study::schedule_from_json(
      record::unsealed(store.events(session).front(), key_of_session(store, key, session)).value(),
      key);
}

/// All trials, with answers and times.
[[nodiscard]] inline std::vector<record::TrialRow> opened_trials(const record::StudyStore& store,
                                                                 const study::StudyKey& key) {
  record::DerivedRows rows;
  for (const record::SessionRow& row : store.sessions()) {
    const SecretKey own = key_of_session(store, key, row.session);
    for (const record::Event& event : as_recorded(store.events(row.session), own)) {
      fold(rows, event);
    }
  }
  std::vector<record::TrialRow> trials;
  for (const auto& [id, row] : rows.trials) trials.push_back(row);
  return trials;
}

[[nodiscard]] inline Confusion confusion_of(const record::StudyStore& store,
                                            const study::StudyKey& key) {
  std::map<int, study::Schedule> schedules;
  for (const record::SessionRow& row : store.sessions()) {
    schedules[row.session] = schedule_of_session(store, key, row.session);
  }
  Confusion confusion;
  for (const record::TrialRow& row : opened_trials(store, key)) {
    const study::Schedule& schedule = schedules[row.session];
    const int presented = schedule.trials.at(row.trial - 1).field().class_index;
    if (position_of(row.answer))
      ++confusion[{presented, schedule.layout.at(*position_of(row.answer))}];
  }
  return confusion;
}

[[nodiscard]] inline int correct_of(const Confusion& confusion) {
  int correct = 0;
  for (const auto& [cell, count] : confusion) correct += cell.first == cell.second ? count : 0;
  return correct;
}

}  // namespace touchtrial
