/// \file What single events say of a session. Private to analysis.
#pragma once

#include "analysis/collection.hpp"

#include <span>

namespace touchtrial {

/// The kinds of events on sessions' chains that tell how they were collected.
[[nodiscard]] std::span<const EventKind> kinds_in_sessions();

/// Adds what one event says, of the session's chain or of the file's. \param session  that it is of
void add_to_record(const Event& event, SessionRecord& session);

/// The trial's servo, if it was in real time.
[[nodiscard]] std::optional<ServoTrial> servo_trial_of(const Event& trace_stored);

/// Participants, each by the last of their sessions.
/// \param rows  by number
[[nodiscard]] ParticipantFlow participant_flow(const std::vector<SessionRow>& rows,
                                               const std::vector<SessionRecord>& records,
                                               const StudyCommitment& commitment,
                                               const StudyState& state);

}  // namespace touchtrial
