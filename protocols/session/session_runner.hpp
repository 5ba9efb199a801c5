/// \file A whole session, in virtual or real time: the state machine, somebody who answers,
/// somebody who looks after it, and a device. What differs between the two is injected: the clock,
/// how an exploration runs, and where the device comes from.
#pragma once

#include "device/device_settings.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/session/device_supply.hpp"
#include "protocols/session/experimenter.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/session/practice_textures.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/session_clock.hpp"
#include "protocols/session/session_texts.hpp"
#include "protocols/session/stimulus_source.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace touchtrial::session {

/// What a session came to, apart from outcomes.
struct SessionTally {
  int presentations = 0;  ///< interrupted ones included
  int invalid_trials = 0;
  std::int64_t ticks = 0;
  std::chrono::nanoseconds duration{};
  /// Why it was left open, to be taken up again; empty: it is closed.
  std::optional<std::string> left{};
};

/// Nobody who runs the session: nothing is shown, asked for or ticked.
[[nodiscard]] Experimenter& no_experimenter();
/// Nothing to read and nothing to ask.
[[nodiscard]] const SessionTexts& no_texts();

/// What a session is run with. Everything must outlive the run.
struct SessionParts {
  const design::StudyKey& key;
  const StimulusSource& source;
  Participant& participant;
  SessionClock& clock;
  Explorer& explorer;
  DeviceSupply& devices;
  double rate_hz = device::kServoRateHz;  ///< of the servo
  Experimenter& experimenter = no_experimenter();
  const SessionTexts& texts = no_texts();
  const PracticeTextures* practice = nullptr;  ///< null: nobody practises
  std::string participant_name{};              ///< as the experimenter is shown it
  std::string device_name{};                   ///< likewise
  device::LabLimits limits{};                  ///< of the device, beside the study's
};

/// Runs a session that is open, or was taken up again, to its closing: day sheet, instructions,
/// questions and practice as far as they are not done yet, trials, closing questions.
///
/// Nothing stored in clear depends on what is presented, but for answers and the validity of
/// trials. An answer is acknowledged once it is durable. A presentation that ends in a fault or a
/// comfort stop is marked as interrupted, and the study says what becomes of it; before the next
/// one the session is paused until the device supply is ready again. The session is stopped when
/// the supply gives up, the experimenter aborts it, or interruptions outnumber its trials. It is
/// left open when the experimenter leaves it, or a signal asked the program to end
/// (StopOnSignals::asked). No force is on when it returns or throws.
/// \throws StoreError if an event could not be stored; what participant, experimenter and supply
///   throw
SessionTally run_session(Session& session, const SessionParts& parts);

/// The same in virtual time, from 0 on: with a participant who brings a simulated hand.
SessionTally run_session_in_virtual_time(Session& session, const design::StudyKey& key,
                                         const StimulusSource& source, Participant& participant);

}  // namespace touchtrial::session
