/// \file The participants' answers, read from a database with the study's key.
#pragma once

#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <map>
#include <utility>

namespace touchtrial {

/// Counts of (presented class, answered class).
using Confusion = std::map<std::pair<int, int>, int>;

[[nodiscard]] inline design::Schedule schedule_of_session(const store::StudyStore& store,
                                                          const design::StudyKey& key,
                                                          int session) {
  const auto participant_key =
      store::unwrap_participant_key(key.box(), session, store.wrapped_key(session).value());
  return design::schedule_from_json(
      store::unsealed(store.events(session).front(), participant_key.value()).value(), key);
}

[[nodiscard]] inline Confusion confusion_of(const store::StudyStore& store,
                                            const design::StudyKey& key) {
  std::map<int, design::Schedule> schedules;
  for (const store::SessionRow& row : store.sessions()) {
    schedules[row.session] = schedule_of_session(store, key, row.session);
  }
  Confusion confusion;
  for (const store::TrialRow& row : store.trials()) {
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
