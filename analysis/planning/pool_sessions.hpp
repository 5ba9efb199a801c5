/// \file Runs complete sessions of one simulated participant in virtual time, without storing them.
/// Planning draws samples from pools of such participants.
#pragma once

#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/order.hpp"
#include "study/study_key.hpp"

#include <functional>

namespace touchtrial::planning {

/// Settings shared by the sessions of a pool; the referenced objects must outlive the sessions.
struct PoolSetting {
  const study::StudyKey& key;
  const session::StimulusSource& source;
  const simulation::SubjectModel& subject;
  const simulation::Population& population;
};

/// Called with each answer to a trial of the schedule, in order.
/// \param order  the order that chose the trial
/// \param shown  the trial as presented
using AnswerObserver =
    std::function<void(const study::Order& order, const study::Trial& shown, const Answer& answer)>;

/// Runs the participant's sessions at all visits, identical to the sessions of `simulate` with the
/// population's seed. Thread-safe if `on_answer` is.
/// \param number  of the participant, from 1
/// \return whether all sessions reached their end; stops after the first that did not
[[nodiscard]] bool run_pool_sessions(const PoolSetting& setting, int number,
                                     const AnswerObserver& on_answer);

}  // namespace touchtrial::planning
