/// \file A whole session, in virtual or real time: the state machine, somebody who answers, and a
/// device. What differs between the two is injected: the clock, how an exploration runs, and where
/// the device comes from.
#pragma once

#include "protocols/design/study_key.hpp"
#include "protocols/session/device_supply.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/session_clock.hpp"
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

/// What a session is run with. Everything must outlive the run.
struct SessionParts {
  const StudyKey& key;
  const StimulusSource& source;
  Participant& participant;
  SessionClock& clock;
  Explorer& explorer;
  DeviceSupply& devices;
  double rate_hz = kServoRateHz;  ///< of the servo
};

/// Runs a session that is open from calibration to its closing.
///
/// Nothing stored in clear depends on what is presented, but for answers and the validity of
/// trials. A presentation that ends in a fault or a comfort stop is marked as interrupted and
/// repeated at the end; before the next one the session is paused until the device supply is ready
/// again. It is stopped when the supply gives up, or when interruptions outnumber its trials.
/// No force is on when it throws.
/// \throws StoreError if an event could not be stored; what participant and supply throw
SessionTally run_session(Session& session, const SessionParts& parts);

/// The same in virtual time, from 0 on: with a participant who brings a simulated hand.
SessionTally run_session_in_virtual_time(Session& session, const StudyKey& key,
                                         const StimulusSource& source, Participant& participant);

}  // namespace touchtrial
