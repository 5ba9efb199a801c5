/// \file The bodies of events as compact JSON with sorted keys, and back. Reading requires all
/// members of a body and ignores keys that a later version may add. Format:
/// docs/data-dictionary.md, "Events".
#pragma once

#include "record/payload.hpp"

#include <string>

namespace touchtrial::record {

struct MarksBody;

/// Takes every struct of payload.hpp that is a body or a sealed part, except TrialBody and
/// BlockBody.
/// \throws StoreError if a text is not UTF-8 or a number is not finite
template <typename Body>
[[nodiscard]] std::string to_json(const Body& body);
[[nodiscard]] std::string presented_to_json(int trial, int block);
/// \param detail  null: not in real time
[[nodiscard]] std::string interrupted_to_json(int trial, const std::string& reason,
                                              const InterruptionDetail* detail);
[[nodiscard]] std::string trial_to_json(int trial);
[[nodiscard]] std::string block_to_json(int block, int first_trial);
[[nodiscard]] std::string remark_to_json(const std::string& text);

/// The body of a station's event as a collected study holds it: `session` is the session's number
/// there; everything else is unchanged.
/// \throws StoreError if the text is not a body about a session
[[nodiscard]] std::string renumbered(const std::string& body, int session);
/// The same for a `session-opened`, which also gets the session's station.
[[nodiscard]] std::string renumbered_opening(const std::string& body, int session, int station);

/// All readers throw StoreError if the text is not such a body; the message names the key.
template <typename Body>
[[nodiscard]] Body from_json(const std::string& text);

inline constexpr auto* commitment_from_json = &from_json<StudyCommitment>;
inline constexpr auto* opening_from_json = &from_json<SessionOpening>;
inline constexpr auto* answer_from_json = &from_json<AnswerBody>;
inline constexpr auto* practice_from_json = &from_json<PracticeBody>;
inline constexpr auto* stop_from_json = &from_json<StopBody>;
inline constexpr auto* deviation_from_json = &from_json<DeviationBody>;
inline constexpr auto* pause_from_json = &from_json<PauseBody>;
inline constexpr auto* resumed_from_json = &from_json<ResumedBody>;
inline constexpr auto* trace_body_from_json = &from_json<TraceBody>;
inline constexpr auto* interruption_from_json = &from_json<InterruptionDetail>;
/// \throws StoreError also if the lists differ in length
[[nodiscard]] MarksBody marks_from_json(const std::string& text);
inline constexpr auto* closed_from_json = &from_json<ClosedBody>;
inline constexpr auto* chain_end_from_json = &from_json<ChainEnd>;
inline constexpr auto* session_opened_from_json = &from_json<SessionOpenedBody>;
inline constexpr auto* session_closed_from_json = &from_json<SessionClosedBody>;
inline constexpr auto* participant_from_json = &from_json<ParticipantBody>;
inline constexpr auto* withdrawal_from_json = &from_json<WithdrawalBody>;
inline constexpr auto* replacement_from_json = &from_json<ReplacementBody>;
inline constexpr auto* note_from_json = &from_json<NoteBody>;
inline constexpr auto* unblinding_from_json = &from_json<UnblindingBody>;
inline constexpr auto* loss_from_json = &from_json<LossBody>;
inline constexpr auto* heads_from_json = &from_json<HeadsBody>;
/// The other members where the body has them.
inline constexpr auto* trial_from_json = &from_json<TrialBody>;
inline constexpr auto* block_from_json = &from_json<BlockBody>;
[[nodiscard]] TrialMeasures measures_from_json(const std::string& text);
[[nodiscard]] std::string remark_from_json(const std::string& text);
/// The number of the session that a body on the file's chain is about.
[[nodiscard]] int session_from_json(const std::string& text);

}  // namespace touchtrial::record
