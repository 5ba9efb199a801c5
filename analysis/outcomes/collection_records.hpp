/// \file Reads the facts about a session from its events. Private to analysis.
#pragma once

#include "analysis/outcomes/collection.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The kinds of events on sessions' chains that describe how the sessions were collected.
[[nodiscard]] std::span<const record::EventKind> collection_event_kinds();

/// Whether events of this kind have sealed data that `add_to_record` reads.
[[nodiscard]] bool is_partly_sealed(record::EventKind kind);

/// Adds the facts from one event to a session's record.
/// \param event  an event of the session's chain, stored or opened, or of the file's chain
/// \param session  the record to extend
void add_to_record(const record::Event& event, SessionRecord& session);

/// \return the servo's timing, or nothing if the trial was not in real time
[[nodiscard]] std::optional<ServoTrial> servo_trial_of(const record::Event& trace_stored);

/// The days of the first and the last real-time session, such as "2026-01-31".
struct CollectionDates {
  std::string first;
  std::string last;
};

/// \return nothing if no session was in real time
[[nodiscard]] std::optional<CollectionDates> dates_of(const std::vector<SessionRecord>& sessions);

/// Sentences about participants who withdrew but let their data be used, and about looks at single
/// participants' outcomes.
[[nodiscard]] std::vector<std::string> people_notes(const Collection& collection);

/// Counts participants, each by the last session among the needed visits.
/// \param rows  sessions in order of their numbers
[[nodiscard]] ParticipantFlow participant_flow(const std::vector<record::SessionRow>& rows,
                                               const std::vector<SessionRecord>& records,
                                               const record::StudyCommitment& commitment,
                                               const record::StudyState& state);

}  // namespace touchtrial::analysis
