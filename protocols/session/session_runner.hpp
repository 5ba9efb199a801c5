/// \file A complete session, in virtual or real time: a state machine, a participant, an
/// experimenter and a device. For virtual or real time, the caller provides the clock, the
/// explorer, and the device supply.
#pragma once

#include "device/device_settings.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/experimenter.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/session_clock.hpp"
#include "protocols/session/session_stages.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "study/protocol.hpp"
#include "study/study_key.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace touchtrial::session {

/// Counts of a session, without outcomes.
struct SessionTally {
  int presentations = 0;  ///< including interrupted ones
  int invalid_trials = 0;
  std::int64_t ticks = 0;
  std::chrono::nanoseconds duration{};
  /// Why the session was left open for later; empty: it is closed.
  std::optional<std::string> left{};
};

/// An experimenter who makes no requests and ticks nothing.
[[nodiscard]] Experimenter& no_experimenter();
/// Texts without instructions and questions.
[[nodiscard]] const SessionTexts& no_texts();

class Instruments;

/// The parts of a session, which must outlive the run.
struct SessionParts {
  const study::StudyCodes& key;
  const StimulusSource& source;
  Participant& participant;
  SessionClock& clock;
  Explorer& explorer;
  DeviceSupply& devices;
  double rate_hz = device::kServoRateHz;  ///< of the servo
  Experimenter& experimenter = no_experimenter();
  const SessionTexts& texts = no_texts();
  /// Practice rounds by number, from 1; the same number always gives the same round. Empty: no
  /// practice.
  std::function<study::Practice(int round)> practice{};
  std::string participant_name{};      ///< for the experimenter
  std::string device_name{};           ///< for the experimenter
  device::LabLimits limits{};          ///< the laboratory's, in addition to the study's
  Instruments* instruments = nullptr;  ///< receives marks of the session's events in real time
};

/// Runs an opened or resumed session until it is closed or left: the remaining opening stages, the
/// trials, and the closing questions.
///
/// Unencrypted events do not depend on stimuli, with two exceptions: whether the exploration was
/// long enough and the hand within its windows (record::HandWindows), and the summary at a
/// session's end (record::ClosedBody). An answer is acknowledged once it is durable.
///
/// A presentation that ends in a fault or a comfort stop is recorded as interrupted, and the
/// study's settings determine whether it is repeated; the session is paused until the device supply
/// is ready again. The session is stopped when the supply gives up, the experimenter aborts it, or
/// interruptions outnumber its trials. It is left open when the experimenter leaves it, or a signal
/// requests the end of the program (StopOnSignals::stop_requested). No force is on when this
/// returns or throws.
/// \throws StoreError if an event could not be stored
/// \throws exceptions of participant, experimenter and supply
SessionTally run_session(Session& session, const SessionParts& parts);

/// Runs a session in virtual time, which starts at 0.
/// \param participant  has a simulated hand
SessionTally run_session_in_virtual_time(Session& session, const study::StudyCodes& key,
                                         const StimulusSource& source, Participant& participant);

}  // namespace touchtrial::session
