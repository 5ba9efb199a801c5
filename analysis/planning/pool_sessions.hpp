/// \file Whole sessions of one simulated participant in virtual time, of which nothing is stored:
/// for pools of people, from whom planning draws samples.
#pragma once

#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/order.hpp"
#include "study/study_key.hpp"

#include <functional>

namespace touchtrial::planning {

/// What the sessions of a pool share; everything must outlive them.
struct PoolSetting {
  const study::StudyKey& key;
  const session::StimulusSource& source;
  const simulation::SubjectModel& subject;
  const simulation::Population& population;
};

/// Called with each answer to a trial of the schedule, in order.
/// \param order  whose trial it is
/// \param shown  as it was presented
using NoteAnswer =
    std::function<void(const study::Order& order, const study::Trial& shown, const Answer& answer)>;

/// Holds the participant's sessions at all visits, those of `simulate` with the population's seed.
/// Thread-safe if `note` is.
/// \param number  of the participant, from 1
/// \return whether all sessions reached their end; there are none after one that did not
[[nodiscard]] bool hold_pool_sessions(const PoolSetting& setting, int number,
                                      const NoteAnswer& note);

}  // namespace touchtrial::planning
