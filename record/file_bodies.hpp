/// \file The bodies of events on the file's chain. Each struct is one JSON object; `describe`
/// lists its members.
#pragma once

#include "core/hash.hpp"
#include "core/public_keys.hpp"
#include "record/body_io.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::record {

/// The station that a file belongs to.
struct StationIdentity {
  std::string name;
  PublicKey key{};
  Signature certificate{};

  void describe(BodyIo& io) {
    io("name", name, "the station's name");
    io("key", key, "Ed25519 public half that verifies what the station signed");
    io("certificate", certificate, "the investigator's signature of name and key");
  }
  friend bool operator==(const StationIdentity&, const StationIdentity&) = default;
};

/// `study-committed`.
struct StudyCommitment {
  std::string study;
  std::string protocol;
  std::string study_id;
  Digest seal{};
  Digest pack{};  ///< Pack::digest of the prepared fields
  std::string configuration;
  int scored_trials = 0;
  int positions = 0;
  bool simulated = false;
  bool pilot = false;
  int safety_record_years = 10;
  std::string program_version;
  PublicKey investigator{};
  std::optional<StationIdentity> station{};

  void describe(BodyIo& io) {
    io("study", study, "the study's name");
    io("protocol", protocol, "the protocol's name");
    io("study_id", study_id, "public identity of the key, hexadecimal");
    io("seal", seal, "hash over key, schedule rule, configuration and a nonce");
    io("pack", pack, "digest of the prepared fields");
    io("configuration", configuration, "the configuration in clear, as JSON");
    io("scored_trials", scored_trials, "presentations to a participant that count");
    io("positions", positions, "pictures to choose from");
    io("simulated", simulated, "whether participants are simulated");
    io("pilot", pilot, "whether the database contains only pilot sessions");
    io("safety_record_years", safety_record_years,
       "years for which the safety record of an erased person is kept");
    io("program_version", program_version, "version of the program");
    io("investigator", investigator,
       "Ed25519 public half that verifies what the investigator signed");
    io.part("station", station, "absent in a collected study");
  }
  friend bool operator==(const StudyCommitment&, const StudyCommitment&) = default;
};

/// `session-opened`.
struct SessionOpenedBody {
  int session = 0;
  std::string participant;
  int enrolment = 0;
  int visit = 1;
  Digest first{};
  Digest key{};
  Digest safety_key{};
  std::optional<Digest> kept{};
  PublicKey remarks{};
  PublicKey reasons{};
  int station = 0;      ///< 0: not collected
  int own_session = 0;  ///< 0: not collected

  void describe(BodyIo& io) {
    io("session", session, "the session's number", {.min = 1});
    io("participant", participant, "the participant's id");
    io("enrolment", enrolment, "decides the schedule", {.min = 1});
    io.omit_if(1, "visit", visit, "of the participant; absent: the first", {.min = 2});
    io("first", first, "hash of the session's `opened`");
    io("key", key, "SHA-256 of the participant's wrapped key");
    io("safety_key", safety_key, "SHA-256 of the wrapped safety key");
    io("kept", kept,
       "SHA-256 of the station's copy of the key, which is stored while the session is open; "
       "absent: it began without one");
    io("remarks", remarks, "public half that seals remarks about the participant");
    io("reasons", reasons, "public half that seals reasons and deviations");
    io.omit_if_empty("station", station, "the session's station, in a collected study", {.min = 1});
    io.omit_if_empty("own_session", own_session, "its number at that station, in a collected study",
                     {.min = 1});
  }
};

/// `session-closed`.
struct SessionClosedBody {
  int session = 0;
  std::int64_t length = 0;
  Digest head{};
  bool complete = false;

  void describe(BodyIo& io) {
    io("session", session, "the session's number", {.min = 1});
    io("length", length, "number of events of its chain", {.min = 1});
    io("head", head, "hash of the last of these events");
    io("complete", complete, "whether the schedule was finished");
  }
};

/// `participant-excluded`.
struct ParticipantBody {
  int session = 0;
  std::string reason;
  bool after_outcomes = false;

  void describe(BodyIo& io) {
    io("session", session, "the session's number", {.min = 1});
    io("reason", reason, "why", {.sealed = true});
    io.omit_if_empty("after_outcomes", after_outcomes, "the participant's outcomes had been seen");
  }
};

/// The participant's data that a withdrawal retains. Erased data cannot be restored.
enum class Retention {
  data,           ///< everything; the participant only leaves the study
  safety_record,  ///< stops, faults, largest forces, reasons and deviations
  nothing         ///< no sealed data
};
inline constexpr std::array<std::string_view, 3> kRetentionNames = {"data", "safety-record",
                                                                    "nothing"};

/// `participant-withdrawn`.
struct WithdrawalBody {
  int session = 0;
  Retention kept{};
  std::string reason;
  std::string not_erased{};

  void describe(BodyIo& io) {
    io("session", session, "the session's number", {.min = 1});
    io.choice("kept", kept, kRetentionNames, "the retained data, see [Withdrawal](#withdrawal)");
    io("reason", reason, "why", {.sealed = true});
    io.omit_if_empty("not_erased", not_erased, "copies that the erasure does not reach");
  }
};

/// `participant-replaced`.
struct ReplacementBody {
  int session = 0;
  std::string by;
  std::string reason;

  void describe(BodyIo& io) {
    io("session", session, "the session's number", {.min = 1});
    io("by", by,
       "the participant who inherits its enrolment number; the same participant: the session was "
       "restarted");
    io("reason", reason, "why", {.sealed = true});
  }
};

/// `participant-noted`.
struct NoteBody {
  int session = 0;
  std::string code;
  std::string text;

  void describe(BodyIo& io) {
    io("session", session, "the session's number", {.min = 1});
    io("code", code, "code of a deviation, which belongs to the safety record; empty: a remark");
    io("text", text, "what was noted", {.sealed = true});
  }
};

/// `heads-kept`.
struct HeadsBody {
  std::string also;

  void describe(BodyIo& io) { io("also", also, "folder of a second head file; empty: none"); }
};

/// `loss-accepted`.
struct LossBody {
  std::string reason;
  std::string missing;
  std::int64_t answers = 0;

  void describe(BodyIo& io) {
    io("reason", reason, "why");
    io("missing", missing, "what the database lacks, without outcomes");
    io("answers", answers, "acknowledged answers that are lost");
  }
};

/// `study-unblinded`.
struct UnblindingBody {
  std::string reason;
  bool interim = false;
  bool question_alone = false;
  std::optional<std::vector<int>> sessions{};
  std::string participant{};

  void describe(BodyIo& io) {
    io("reason", reason, "why");
    io("interim", interim, "the study was still open");
    io.omit_if_empty("question_alone", question_alone,
                     "shows only the answer to the registered question");
    io("sessions", sessions,
       "in a collected study, the sessions that an interim look, or one at a participant, shows",
       {.min = 1});
    io.omit_if_empty("participant", participant,
                     "the only participant whose outcomes are shown; absent: all participants");
  }
};

}  // namespace touchtrial::record
