/// \file What the study key opens in a database: participants' keys, schedules, measures.
#pragma once

#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace touchtrial::analysis {

/// \throws VerificationError that names what differs, if `key` is not the one that the database was
///   sealed under
void require_key_of(const store::StudyStore& store, const design::StudyKey& key);

/// The key that a participant's payloads are encrypted under.
/// \return nothing if the participant has withdrawn
/// \throws VerificationError if the row is missing without a withdrawal, or does not open
[[nodiscard]] std::optional<SecretKey> participant_key(const store::StudyStore& store,
                                                       const design::StudyKey& key,
                                                       const store::SessionRow& session);

/// The keys of all sessions that have not withdrawn. \throws the same
[[nodiscard]] std::map<int, SecretKey> participant_keys(const store::StudyStore& store,
                                                        const design::StudyKey& key);

/// The text of an event's sealed part. \param own  the participant's key
/// \throws VerificationError, naming the event, if it does not open
[[nodiscard]] std::string opened_part(const store::Event& event, const SecretKey& own);

/// Holds the chain of every session that has ended, and has not withdrawn, against the end that was
/// sealed when it ended. Whoever lacks the key can make a chain anew, but not this end of it.
/// \throws VerificationError, naming the session, if one is another chain's
void require_sealed_ends(const store::StudyStore& store, const design::StudyKey& key);

/// Schedules and layouts of all sessions that have not withdrawn, by session. Blocks that came
/// again, in their new order, follow the schedule with which the session began.
/// \throws VerificationError, naming the session, if one does not open or is no schedule of this
/// key
[[nodiscard]] std::map<int, design::Schedule> open_schedules(const store::StudyStore& store,
                                                             const design::StudyKey& key);

/// A session and the number of a trial in it.
using TrialPlace = std::pair<int, int>;

/// Measures of all trials with a trace, of sessions that have not withdrawn. Of a repeated trial
/// the last counts. \throws VerificationError, naming the session, if one does not open
[[nodiscard]] std::map<TrialPlace, store::TrialMeasures> open_measures(
    const store::StudyStore& store, const design::StudyKey& key);

}  // namespace touchtrial::analysis
