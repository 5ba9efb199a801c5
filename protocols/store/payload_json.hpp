/// \file The bodies of events as compact JSON with sorted keys, and back. Reading is strict about
/// what a body must hold and tolerant of keys that a later version may add.
/// Format: docs/data-dictionary.md, "Events".
#pragma once

#include "core/hash.hpp"
#include "protocols/store/payload.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::store {

/// `session-opened` on the file's chain: ties a session's chain and key to the file.
struct SessionOpenedBody {
  int session = 0;
  std::string participant;
  int enrolment = 0;
  Digest first{};  ///< hash of the session's `opened`
  Digest key{};    ///< SHA-256 of the wrapped participant key
  /// In a collected study: the station that the session comes from, from 1, and its number there.
  int station = 0;
  int own_session = 0;
};

/// `session-closed` on the file's chain: how the session's chain ends.
struct SessionClosedBody {
  int session = 0;
  std::int64_t length = 0;  ///< number of events
  Digest head{};            ///< hash of the last
  bool complete = false;
};

/// `participant-excluded`, `participant-withdrawn`.
struct ParticipantBody {
  int session = 0;
  std::string reason;
};

/// `participant-replaced`.
struct ReplacementBody {
  int session = 0;
  std::string by;  ///< participant who inherits the enrolment number; the same one: restarted
  std::string reason;
};

/// `participant-noted`.
struct NoteBody {
  int session = 0;
  std::string code;  ///< of a deviation; empty: a remark
  std::string text;
};

/// `study-unblinded`.
struct UnblindingBody {
  std::string reason;
  bool interim = false;
  /// In a collected study: the sessions that the stations' interim looks show.
  std::optional<std::vector<int>> sessions{};
};

/// `block-restarted`: which block, from 0, and the number of its first trial from now on.
struct BlockBody {
  int block = 0;
  int first_trial = 0;
};

/// \throws StoreError if a text is not UTF-8 or a number is not finite
[[nodiscard]] std::string to_json(const StudyCommitment& body);
[[nodiscard]] std::string to_json(const SessionOpening& body);
[[nodiscard]] std::string to_json(const AnswerBody& body);
[[nodiscard]] std::string to_json(const PracticeBody& body);
[[nodiscard]] std::string to_json(const DeviationBody& body);
[[nodiscard]] std::string to_json(const ResumedBody& body);
[[nodiscard]] std::string to_json(const TraceBody& body);
[[nodiscard]] std::string to_json(const TrialMeasures& body);
[[nodiscard]] std::string to_json(const InterruptionDetail& body);
[[nodiscard]] std::string to_json(const ChainEnd& body);
[[nodiscard]] std::string to_json(const SessionOpenedBody& body);
[[nodiscard]] std::string to_json(const SessionClosedBody& body);
[[nodiscard]] std::string to_json(const ParticipantBody& body);
[[nodiscard]] std::string to_json(const ReplacementBody& body);
[[nodiscard]] std::string to_json(const NoteBody& body);
[[nodiscard]] std::string to_json(const UnblindingBody& body);
[[nodiscard]] std::string presented_to_json(int trial, int block);
[[nodiscard]] std::string interrupted_to_json(int trial, const std::string& reason);
[[nodiscard]] std::string trial_to_json(int trial);
[[nodiscard]] std::string block_to_json(int block, int first_trial);
[[nodiscard]] std::string remark_to_json(const std::string& text);
[[nodiscard]] std::string completion_to_json(bool complete);

/// The body of a station's event as it stands in a collected study: all as it was, but `session`,
/// the number of the session that it is about.
/// \throws StoreError if the text is no body about a session
[[nodiscard]] std::string renumbered(const std::string& body, int session);
/// The same of a `session-opened`, which also says where the session comes from.
[[nodiscard]] std::string renumbered_opening(const std::string& body, int session, int station);

/// All readers throw StoreError if the text is no such body; the message names the key.
[[nodiscard]] StudyCommitment commitment_from_json(const std::string& text);
[[nodiscard]] SessionOpening opening_from_json(const std::string& text);
[[nodiscard]] AnswerBody answer_from_json(const std::string& text);
[[nodiscard]] PracticeBody practice_from_json(const std::string& text);
[[nodiscard]] DeviationBody deviation_from_json(const std::string& text);
[[nodiscard]] ResumedBody resumed_from_json(const std::string& text);
[[nodiscard]] TraceBody trace_body_from_json(const std::string& text);
[[nodiscard]] InterruptionDetail interruption_from_json(const std::string& text);
[[nodiscard]] ChainEnd chain_end_from_json(const std::string& text);
[[nodiscard]] SessionOpenedBody session_opened_from_json(const std::string& text);
[[nodiscard]] SessionClosedBody session_closed_from_json(const std::string& text);
[[nodiscard]] ParticipantBody participant_from_json(const std::string& text);
[[nodiscard]] ReplacementBody replacement_from_json(const std::string& text);
[[nodiscard]] NoteBody note_from_json(const std::string& text);
[[nodiscard]] UnblindingBody unblinding_from_json(const std::string& text);
/// `block` and `reason` where the body has them.
[[nodiscard]] TrialBody trial_from_json(const std::string& text);
[[nodiscard]] BlockBody block_from_json(const std::string& text);
[[nodiscard]] std::string remark_from_json(const std::string& text);
[[nodiscard]] bool completion_from_json(const std::string& text);

}  // namespace touchtrial::store
