/// \file A whole session in virtual time: the real state machine, somebody who answers, no waiting.
#pragma once

#include "protocols/design/study_key.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/stimulus_source.hpp"

#include <chrono>
#include <cstdint>

namespace touchtrial {

/// What a session came to, apart from outcomes.
struct SessionTally {
  int presentations = 0;  ///< interrupted ones included
  int invalid_trials = 0;
  std::int64_t ticks = 0;
  std::chrono::nanoseconds duration{};
};

/// Runs a session that is open from calibration to its closing. The session's clock starts at 0 and
/// goes forward by exploring, by the participant's thought, and by constants: nothing stored in
/// clear depends on what is presented, but for answers and the validity of trials. A presentation
/// that ends in a fault is repeated; the session is stopped when faults outnumber its trials.
/// \throws StoreError if an event could not be stored
SessionTally run_session_in_virtual_time(Session& session, const StudyKey& key,
                                         const StimulusSource& source, Participant& participant);

}  // namespace touchtrial
