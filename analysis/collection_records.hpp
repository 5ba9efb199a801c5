/// \file What single events say of a session. Private to analysis.
#pragma once

#include "analysis/collection.hpp"

#include <span>

namespace touchtrial::analysis {

/// The kinds of events on sessions' chains that tell how they were collected.
[[nodiscard]] std::span<const store::EventKind> kinds_in_sessions();

/// Adds what one event says, of the session's chain or of the file's. \param session  that it is of
void add_to_record(const store::Event& event, SessionRecord& session);

/// The trial's servo, if it was in real time.
[[nodiscard]] std::optional<ServoTrial> servo_trial_of(const store::Event& trace_stored);

/// Participants, each by the last of their sessions.
/// \param rows  by number
[[nodiscard]] ParticipantFlow participant_flow(const std::vector<store::SessionRow>& rows,
                                               const std::vector<SessionRecord>& records,
                                               const store::StudyCommitment& commitment,
                                               const store::StudyState& state);

}  // namespace touchtrial::analysis
