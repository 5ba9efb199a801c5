/// \file What the bodies of events hold. Each struct is one JSON object; see
/// docs/data-dictionary.md.
#pragma once

#include "core/hash.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial {

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
};

/// `answered`: positions are indices into the participant's layout of pictures, from 0.
struct AnswerBody {
  int trial = 0;
  int position = 0;
  std::optional<int> first_position;  ///< the answer before a change, if it was changed
  std::optional<int> confidence;
};

/// `trace-stored`: servo health in clear; what was felt is in the sealed part (TrialMeasures).
struct TraceBody {
  int trial = 0;
  std::int64_t samples = 0;
  double rate_hz = 0.0;
  std::int64_t overruns = 0;
  bool valid = true;  ///< by what is in clear: the rest of the validity rule is sealed
  Digest trace{};     ///< SHA-256 of the stored (encrypted) trace
};

/// Sealed part of `trace-stored`: figures that would tell stimuli apart.
struct TrialMeasures {
  double contact_s = 0.0;
  double path_mm = 0.0;  ///< length of the stylus' path while in contact
  double force_rms_n = 0.0;
  double saturated_share = 0.0;  ///< of the ticks in contact
  bool within_limits = true;     ///< the part of the validity rule that tells of forces

  friend bool operator==(const TrialMeasures&, const TrialMeasures&) = default;
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

}  // namespace touchtrial
