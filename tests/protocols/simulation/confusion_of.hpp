/// \file The participants' answers, read from a database with the study's key.
#pragma once

#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"
#include "support/as_recorded.hpp"

#include <map>
#include <utility>
#include <vector>

namespace touchtrial {

/// Counts of (presented class, answered class).
using Confusion = std::map<std::pair<int, int>, int>;

[[nodiscard]] inline SecretKey key_of_session(const store::StudyStore& store,
                                              const design::StudyKey& key, int session) {
  return store::unwrap_participant_key(key.box(), session, store.wrapped_key(session).value())
      .value();
}

[[nodiscard]] inline design::Schedule schedule_of_session(const store::StudyStore& store,
                                                          const design::StudyKey& key,
                                                          int session) {
  return design::schedule_from_json(
      store::unsealed(store.events(session).front(), key_of_session(store, key, session)).value(),
      key);
}

/// All trials, with answers and times.
[[nodiscard]] inline std::vector<store::TrialRow> opened_trials(const store::StudyStore& store,
                                                                const design::StudyKey& key) {
  store::DerivedRows rows;
  for (const store::SessionRow& row : store.sessions()) {
    const SecretKey own = key_of_session(store, key, row.session);
    for (const store::Event& event : as_recorded(store.events(row.session), own)) {
      fold(rows, event);
    }
  }
  std::vector<store::TrialRow> trials;
  for (const auto& [id, row] : rows.trials) trials.push_back(row);
  return trials;
}

[[nodiscard]] inline Confusion confusion_of(const store::StudyStore& store,
                                            const design::StudyKey& key) {
  std::map<int, design::Schedule> schedules;
  for (const store::SessionRow& row : store.sessions()) {
    schedules[row.session] = schedule_of_session(store, key, row.session);
  }
  Confusion confusion;
  for (const store::TrialRow& row : opened_trials(store, key)) {
    const design::Schedule& schedule = schedules[row.session];
    const int presented = schedule.presentations.at(row.trial - 1).stimulus.class_index;
    if (row.position) ++confusion[{presented, schedule.layout.at(*row.position)}];
  }
  return confusion;
}

[[nodiscard]] inline int correct_of(const Confusion& confusion) {
  int correct = 0;
  for (const auto& [cell, count] : confusion) correct += cell.first == cell.second ? count : 0;
  return correct;
}

}  // namespace touchtrial
