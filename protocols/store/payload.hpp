/// \file What the bodies of events hold. Each struct is one JSON object; see
/// docs/data-dictionary.md.
#pragma once

#include "core/hash.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::store {

/// First event of the file's chain: what this database is about, fixed before any trial.
struct StudyCommitment {
  std::string study;          ///< the study's name
  std::string protocol;       ///< "classification" or "comparison"
  std::string study_id;       ///< public identity of the key, hexadecimal
  Digest seal{};              ///< commitment to key, schedule rule, configuration and nonce
  Digest pack{};              ///< Pack::digest of the prepared fields
  std::string configuration;  ///< blinded configuration, compact JSON
  int scored_trials = 0;      ///< presentations a participant that count
  int positions = 0;          ///< pictures to choose from
  bool simulated = false;
  bool pilot = false;
  std::string program_version;

  friend bool operator==(const StudyCommitment&, const StudyCommitment&) = default;
};

/// `opened`, in real time: what the hand was on. Says nothing of stimuli.
struct StationRecord {
  std::string model;          ///< as the device tells it; may be empty
  std::string firmware;       ///< likewise
  double max_force_n = 0.0;   ///< the device's own
  bool visual = false;        ///< shown on a screen instead of felt: pilot sessions alone
  double rate_hz = 0.0;       ///< of the servo, as asked for
  std::string scheduling;     ///< that its thread obtained
  std::string calibration{};  ///< SHA-256 of the device's certificate, hexadecimal; empty: none

  friend bool operator==(const StationRecord&, const StationRecord&) = default;
};

/// First event of a session's chain. Its sealed part is the schedule and the answer layout.
struct SessionOpening {
  std::string participant;  ///< 1 to 32 of [0-9A-Za-z+-_]; unique in a study
  int enrolment = 0;        ///< from 1; decides the schedule; unique in a study
  std::string study_id;
  Digest seal{};
  std::string device;         ///< driver name
  std::string device_serial;  ///< empty if none
  std::string opened_utc;     ///< ISO 8601, empty for simulated sessions
  bool simulated = false;
  bool pilot = false;
  std::optional<StationRecord> station{};  ///< real time only
};

/// `answered`: positions are indices into the participant's layout of pictures, from 0.
struct AnswerBody {
  int trial = 0;
  int position = 0;
  std::optional<int> first_position;  ///< the answer before a change, if it was changed
  std::optional<int> confidence;
};

/// `practised`: one presentation of a practice round, of a texture that is not in the study.
struct PracticeBody {
  int round = 0;         ///< from 1
  int presentation = 0;  ///< in the round, from 1
  int position = 0;      ///< answered, in the practice's own layout
  bool correct = false;
};

/// `deviated`, and `participant-noted` where `code` is not empty.
struct DeviationBody {
  std::string code;  ///< for instance "no-masking-noise"; see docs/data-dictionary.md
  std::string text;  ///< in the experimenter's words; may be empty
};

/// `resumed`.
struct ResumedBody {
  std::string after;              ///< "pause", or "program-ended"
  double away_s = 0.0;            ///< since the last event before
  std::string program_version{};  ///< after the program ended
};

/// `trace-stored`, in real time: how the servo kept its time. When a tick begins is up to the
/// operating system and not to the texture.
struct ServoHealth {
  double rate_hz = 0.0;  ///< that was had
  double lateness_p50_us = 0.0;
  double lateness_p99_us = 0.0;
  double lateness_p999_us = 0.0;
  double lateness_worst_us = 0.0;
  std::int64_t lost = 0;  ///< samples for which there was no room on their way to the trace
  std::int64_t held = 0;  ///< samples of the trace that were filled in, for overruns and lost ones

  friend bool operator==(const ServoHealth&, const ServoHealth&) = default;
};

/// `trace-stored`: servo health in clear; what was felt is in the sealed part (TrialMeasures).
struct TraceBody {
  int trial = 0;
  std::int64_t samples = 0;
  double rate_hz = 0.0;
  std::int64_t overruns = 0;
  bool valid = true;  ///< by what is in clear: the rest of the validity rule is sealed
  Digest trace{};     ///< SHA-256 of the stored (encrypted) trace
  /// Samples of each exploration, where the participant explored again; they add up to `samples`.
  std::vector<std::int64_t> explorations{};
  std::optional<ServoHealth> servo{};  ///< real time only
};

/// Sealed part of `trace-stored`: figures that would tell stimuli apart.
struct TrialMeasures {
  double contact_s = 0.0;
  double path_mm = 0.0;  ///< length of the stylus' path while in contact
  double force_rms_n = 0.0;
  double saturated_share = 0.0;  ///< of the ticks in contact
  bool within_limits = true;     ///< the part of the validity rule that tells of forces
  /// Ticks whose force the safety chain changed; real time only.
  std::optional<std::int64_t> limited_ticks{};

  friend bool operator==(const TrialMeasures&, const TrialMeasures&) = default;
};

/// Sealed part of `interrupted`, in real time: what happened, and the last seconds before it.
struct InterruptionDetail {
  std::string safety_fault;  ///< name of the device layer's SafetyFault
  std::string device_fault;  ///< name of its DeviceFault
  std::int64_t ticks = 0;    ///< rows of the flight record
  std::string flight;        ///< CSV, one row a tick under a row of names; may be empty

  friend bool operator==(const InterruptionDetail&, const InterruptionDetail&) = default;
};

/// Sealed part of `closed`: the chain before it. Without the key no other chain can be given this
/// end.
struct ChainEnd {
  std::int64_t length = 0;  ///< events before `closed`
  Digest head{};            ///< hash of the last of them

  friend bool operator==(const ChainEnd&, const ChainEnd&) = default;
};

/// `presented`, `first-contact`, `interrupted`, `timed-out`: which trial, from 1, and why.
struct TrialBody {
  int trial = 0;
  int block = 0;       ///< `presented` only
  std::string reason;  ///< `interrupted` only
};

}  // namespace touchtrial::store
