/// \file The content of the bodies of events. Each struct is one JSON object; see
/// docs/data-dictionary.md.
#pragma once

#include "core/answer.hpp"
#include "core/hash.hpp"
#include "core/public_keys.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::record {

/// The station that a file belongs to.
struct StationIdentity {
  std::string name;
  PublicKey key{};          ///< verifies what the station signed
  Signature certificate{};  ///< the investigator's, under station_statement

  friend bool operator==(const StationIdentity&, const StationIdentity&) = default;
};

/// `study-committed`, the first event of the file's chain: the study of this database, fixed before
/// any trial.
struct StudyCommitment {
  std::string study;          ///< the study's name
  std::string protocol;       ///< the protocol's name
  std::string study_id;       ///< public identity of the key, hexadecimal
  Digest seal{};              ///< commitment to key, schedule rule, configuration and nonce
  Digest pack{};              ///< Pack::digest of the prepared fields
  std::string configuration;  ///< blinded configuration, compact JSON
  int scored_trials = 0;      ///< presentations a participant that count
  int positions = 0;          ///< pictures to choose from
  bool simulated = false;
  bool pilot = false;
  int safety_record_years = 10;  ///< that the safety record of an erased person is kept
  std::string program_version;
  PublicKey investigator{};                  ///< verifies what the investigator signed
  std::optional<StationIdentity> station{};  ///< empty: several stations' files were collected

  friend bool operator==(const StudyCommitment&, const StudyCommitment&) = default;
};

/// `session-opened`: binds a session's chain and key to the file.
struct SessionOpenedBody {
  int session = 0;
  std::string participant;
  int enrolment = 0;
  int visit = 1;        ///< of the participant, from 1
  Digest first{};       ///< hash of the session's `opened`
  Digest key{};         ///< SHA-256 of the wrapped participant key
  Digest safety_key{};  ///< SHA-256 of the wrapped safety key
  /// SHA-256 of the station's copy of the key, which is there while the session is open; empty: the
  /// session began without one.
  std::optional<Digest> kept{};
  PublicKey remarks{};  ///< seals remarks about the participant
  PublicKey reasons{};  ///< seals reasons and deviations
  /// In a collected study: the session's station, from 1, and its number there; 0 elsewhere.
  int station = 0;
  int own_session = 0;
};

/// `session-closed`: how the session's chain ends.
struct SessionClosedBody {
  int session = 0;
  std::int64_t length = 0;  ///< number of events
  Digest head{};            ///< hash of the last
  bool complete = false;
};

// The texts of the bodies about a person are sealed: empty where the event is not opened.

/// `participant-excluded`.
struct ParticipantBody {
  int session = 0;
  std::string reason;
  bool after_outcomes = false;  ///< the participant's outcomes had been seen
};

/// What a withdrawal retains of the participant. Erased data cannot be restored.
enum class Retention {
  data,           ///< everything; the participant only leaves the study
  safety_record,  ///< stops, faults, largest forces, reasons and deviations
  nothing         ///< nothing that is sealed
};

/// `participant-withdrawn`.
struct WithdrawalBody {
  int session = 0;
  Retention kept{};
  std::string reason;
  std::string not_erased{};  ///< copies that the erasure could not reach; in clear
};

/// `participant-replaced`.
struct ReplacementBody {
  int session = 0;
  std::string by;  ///< participant who inherits the enrolment number; the same one: restarted
  std::string reason;
};

/// `participant-noted`. A deviation's text belongs to the safety record, a remark's does not.
struct NoteBody {
  int session = 0;
  std::string code;  ///< of a deviation; empty: a remark
  std::string text;
};

/// `loss-accepted`.
struct LossBody {
  std::string reason;
  std::string missing;       ///< what the database lacks, as text; names no outcome
  std::int64_t answers = 0;  ///< acknowledged answers that are lost
};

/// `heads-kept`: the database has a head file beside it from now on, and one in another folder.
struct HeadsBody {
  std::string also;  ///< that folder; empty: there is none
};

/// `study-unblinded`.
struct UnblindingBody {
  std::string reason;
  bool interim = false;
  bool question_alone = false;  ///< of an interim look: shows nothing but the registered question
  /// In a collected study: the sessions that the stations' looks show.
  std::optional<std::vector<int>> sessions{};
  std::string participant{};  ///< whose outcomes alone are looked at; empty: everybody's
};

/// `opened`, in real time before a window: the participant's screen.
struct ScreenRecord {
  double mm_per_px = 0.0;  ///< millimetres on the screen for one pixel, as windows count them
  std::string source;      ///< "measured" (with a card), "stated" (by the monitor) or "assumed"

  friend bool operator==(const ScreenRecord&, const ScreenRecord&) = default;
};

/// `opened`, in real time: the device that the hand was on. Reveals nothing about stimuli.
struct StationRecord {
  std::string model;         ///< as the device reports it; may be empty
  std::string firmware;      ///< likewise
  double max_force_n = 0.0;  ///< of the device
  bool visual = false;       ///< shown on a screen instead of felt: pilot sessions only
  double rate_hz = 0.0;      ///< requested rate of the servo
  std::string scheduling;    ///< that the servo's thread obtained
  /// SHA-256 of the device's certificate, hexadecimal; study::kUnverifiedDevice; or empty: none.
  std::string calibration{};
  std::optional<ScreenRecord> screen{};  ///< only of sessions before a window
  /// \name The lab's corrections in force, by axis of the device frame
  ///@{
  std::array<double, 3> force_scale{1.0, 1.0, 1.0};
  std::array<double, 3> length_scale{1.0, 1.0, 1.0};
  ///@}

  friend bool operator==(const StationRecord&, const StationRecord&) = default;
};

/// `opened`, the first event of a session's chain. Its sealed part holds the schedule and the
/// answer layout.
struct SessionOpening {
  std::string participant{};  ///< 1 to 32 of [0-9A-Za-z+-_]; unique in a study
  int enrolment = 0;          ///< from 1; decides the schedule; unique in a study
  int visit = 1;              ///< of the participant, from 1
  std::string group{};        ///< the participant's, if the study's groups are open; else empty
  std::string study_id{};
  Digest seal{};
  std::string device{};         ///< driver name
  std::string device_serial{};  ///< empty if none
  std::string opened_utc{};     ///< ISO 8601, empty for simulated sessions
  bool simulated = false;
  bool pilot = false;
  std::optional<StationRecord> station{};  ///< real time only

  [[nodiscard]] bool is_visual() const noexcept { return station && station->visual; }
};

// Of some bodies only a part is in clear (split_body). Each sealed member's comment states its
// value in an event that is not opened.

/// `answered`. Only the trial is in clear; the other members are then empty.
struct AnswerBody {
  int trial = 0;
  std::optional<Answer> answer{};
  std::optional<int> confidence{};
  /// \name What an adaptive order chose (study::Trial); sealed like all of an answer
  ///@{
  std::optional<std::string> kind{};  ///< of the trial, as in the schedule
  std::optional<int> track{};
  std::optional<int> level{};
  std::optional<int> target{};
  ///@}
};

/// `practised`: one presentation of a practice round, of a texture that is not in the study.
struct PracticeBody {
  int round = 0;                   ///< from 1
  int presentation = 0;            ///< in the round, from 1
  std::optional<Answer> answer{};  ///< in the practice's own layout; sealed
  std::optional<bool> correct{};   ///< sealed; empty too if no answer is right
};

/// `stopped`: why a session ended early.
struct StopBody {
  std::string code{};  ///< the program's reason, in clear; empty: the experimenter stopped it
  std::string text{};  ///< the experimenter's words; may be empty; sealed
};

/// `deviated`, and `participant-noted` where `code` is not empty.
struct DeviationBody {
  std::string code;  ///< for instance "no-masking-noise"; see docs/data-dictionary.md
  std::string text;  ///< in the experimenter's words; may be empty; sealed in `deviated`
};

/// `paused`.
struct PauseBody {
  std::string text{};  ///< the experimenter's reason; may be empty; sealed
  /// The presentation whose answer is pending; empty between presentations.
  std::optional<int> trial{};
};

/// `resumed`.
struct ResumedBody {
  std::string after;              ///< "pause", or "program-ended"
  double away_s = 0.0;            ///< since the previous event; sealed: 0 if not opened
  std::string program_version{};  ///< after the program ended
  std::optional<int> trial{};     ///< as in the pause before
};

/// Reason of an `interrupted` for a pause. The same presentation is the next one, whatever the
/// study does after other interruptions.
inline constexpr const char* kPauseReason = "pause";

/// `presented`, `first-contact`, `interrupted`, `timed-out`.
struct TrialBody {
  int trial = 0;                 ///< from 1
  int block = 0;                 ///< `presented` only
  std::string reason;            ///< `interrupted` only, like the members below
  std::string safety_fault{};    ///< as InterruptionDetail has it
  std::string device_fault{};    ///< likewise
  double largest_force_n = 0.0;  ///< before the interruption; sealed: 0 if not opened
};

/// `block-restarted`: which block, from 0, and the number of its first trial from now on.
struct BlockBody {
  int block = 0;
  int first_trial = 0;
};

/// `trace-stored`, in real time: how well the servo kept time. The start of a tick depends on the
/// operating system and not on the texture.
struct ServoHealth {
  double rate_hz = 0.0;  ///< that was reached
  double lateness_p50_us = 0.0;
  double lateness_p99_us = 0.0;
  double lateness_p999_us = 0.0;
  double lateness_worst_us = 0.0;
  std::int64_t lost = 0;  ///< samples that did not fit into the ring to the trace
  std::int64_t held = 0;  ///< samples of the trace that were filled in, for overruns and lost ones

  friend bool operator==(const ServoHealth&, const ServoHealth&) = default;
};

/// `trace-stored`: whether the hand stayed within each window of the instructions. Only the hand's
/// own motion and force count: with the forces of the texture, the windows would distinguish rough
/// textures from smooth ones.
struct HandWindows {
  bool contact = true;  ///< long enough at the plane
  bool path = true;     ///< far enough along it
  bool force = true;    ///< pressed neither too lightly nor too hard
  bool speed = true;    ///< moved neither too slowly nor too fast

  friend bool operator==(const HandWindows&, const HandWindows&) = default;
};

/// `trace-stored`: the hand's windows and the servo's health in clear; the sealed part
/// (TrialMeasures) describes what was felt.
struct TraceBody {
  int trial = 0;
  std::int64_t samples = 0;  ///< sealed: 0 if not opened
  double rate_hz = 0.0;
  std::int64_t overruns = 0;
  bool valid = true;  ///< by the clear part of the validity rule; the other part is sealed
  HandWindows hand{};
  bool saturated = false;        ///< too often at the force limit; sealed: false if not opened
  Digest trace{};                ///< BLAKE2b of the stored (encrypted) trace
  double largest_force_n = 0.0;  ///< of the trace; sealed: 0 if not opened
  /// Samples of each exploration, if the participant explored again; they add up to `samples`.
  /// Sealed: empty if not opened.
  std::vector<std::int64_t> explorations{};
  /// When the first sample of each exploration was taken, since the presentation began. Sealed.
  /// Empty: of one exploration, at once; of several, not recorded.
  std::vector<std::int64_t> began_ns{};
  std::optional<ServoHealth> servo{};  ///< real time only
};

/// Sealed part of `trace-stored`: numbers that depend on the stimulus.
struct TrialMeasures {
  double contact_s = 0.0;
  double path_mm = 0.0;  ///< length of the stylus' path while in contact
  double force_rms_n = 0.0;
  double saturated_share = 0.0;  ///< of the ticks in contact
  bool within_limits = true;     ///< the part of the validity rule that depends on forces
  /// Ticks whose force the safety chain changed; real time only.
  std::optional<std::int64_t> limited_ticks{};

  friend bool operator==(const TrialMeasures&, const TrialMeasures&) = default;
};

/// `interrupted`, in real time: the faults, and the last seconds before them. The faults' names are
/// also in clear.
struct InterruptionDetail {
  std::string safety_fault;      ///< name of the device layer's SafetyFault
  std::string device_fault;      ///< name of its DeviceFault
  std::int64_t ticks = 0;        ///< rows of the flight record
  std::string flight;            ///< CSV, one row a tick under a row of names; may be empty
  double largest_force_n = 0.0;  ///< of these ticks; a sealed member of the body

  friend bool operator==(const InterruptionDetail&, const InterruptionDetail&) = default;
};

/// Rounds to a multiple of 0.1, printed with one decimal.
[[nodiscard]] inline double in_tenths(double number) {
  return std::round(10.0 * number) / 10.0;
}

/// `closed`. Without the distribution of answers, which is the outcome if positions have meanings.
struct ClosedBody {
  bool complete = false;  ///< whether the schedule was finished
  int answers = 0;        ///< answered presentations
  bool one_key = false;   ///< see session::Session::close
  /// Over all presentations, to tenths of a newton; sealed, because weak levels of an adaptive
  /// track need less. Empty: none, or not opened.
  std::optional<double> largest_force_n{};
};

/// Sealed part of `closed`: the chain before it. Without the key, another chain cannot be given
/// this end.
struct ChainEnd {
  std::int64_t length = 0;  ///< events before `closed`
  Digest head{};            ///< hash of the last of them

  friend bool operator==(const ChainEnd&, const ChainEnd&) = default;
};

}  // namespace touchtrial::record
