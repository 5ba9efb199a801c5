/// \file Opens the sealed parts of a database with the study key: participants' keys, events,
/// schedules, answers and measures.
#pragma once

#include "analysis/outcomes/study_events.hpp"
#include "record/person_texts.hpp"
#include "record/study_store.hpp"
#include "record/trace.hpp"
#include "study/study_key.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// Requires that the database was sealed under this key.
/// \throws VerificationError, naming the difference, if it was not
void require_key_of(const record::StudyStore& store, const study::StudyKey& key);

/// The key under which a participant's payloads are encrypted.
/// \return the key, or nothing if it was erased
/// \throws VerificationError if the participant's key is missing without a withdrawal, or does not
///   open
[[nodiscard]] std::optional<SecretKey> participant_key(const record::StudyStore& store,
                                                       const study::StudyKey& key,
                                                       const record::SessionRow& session);

/// The keys of a session that have not been erased.
/// \throws VerificationError as participant_key does, for either key
[[nodiscard]] record::PersonKeys person_keys(const record::StudyStore& store,
                                             const study::StudyKey& key,
                                             const record::SessionRow& session);

/// The same for every session. Keys are unwrapped once and shared by all readers of a study.
using SessionKeys = std::map<int, record::PersonKeys>;
/// \throws the same
[[nodiscard]] SessionKeys person_keys(const record::StudyStore& store, const study::StudyKey& key);

/// A session's event as it was recorded.
/// \param own  the participant's key
/// \throws VerificationError, naming the event, if it does not open
[[nodiscard]] record::OpenedEvent whole_event(const record::Event& event, const SecretKey& own);
/// The same with any remaining key, for an event of any chain.
/// \param row  of the session that the event is about
/// \return the event as it is stored, if its key was erased
/// \throws the same
[[nodiscard]] record::Event readable_event(const record::Event& event,
                                           const record::SessionRow& row,
                                           const record::PersonKeys& keys);

/// Measures by session and number of the trial.
using Measures = std::map<std::pair<int, int>, record::TrialMeasures>;

/// The trials of all sessions that are not erased, with answers and times, by session and trial.
/// \throws VerificationError, naming the event, if one does not open or cannot follow those before
[[nodiscard]] std::vector<record::TrialRow> open_trials(const record::StudyStore& store,
                                                        const SessionKeys& keys);

/// A study with its key. Every event is read, checked and opened once, in parallel over sessions.
class OpenedSessions {
 public:
  /// \throws VerificationError if chains or derived tables are damaged (traces are not checked), or
  ///   as person_keys
  OpenedSessions(const record::StudyStore& store, const study::StudyKey& key);
  ~OpenedSessions();
  OpenedSessions(const OpenedSessions&) = delete;
  OpenedSessions& operator=(const OpenedSessions&) = delete;

  [[nodiscard]] const SessionKeys& keys() const noexcept { return keys_; }
  /// The kept events (StudyEvents::is_kept), as stored.
  [[nodiscard]] const StudyEvents& events() const noexcept { return events_; }
  /// As open_trials. Call at most once.
  /// \param measures  receives the measures of all trials with a trace; for a repeated trial, of
  ///   the last presentation
  [[nodiscard]] std::vector<record::TrialRow> take_trials(Measures& measures);

 private:
  struct Session;

  std::map<int, Session> sessions_;
  SessionKeys keys_;
  StudyEvents events_;
};

/// Compares the chain of every ended session that is not erased with its sealed end. Without the
/// key a chain can be rebuilt, but its end cannot be sealed.
/// \throws VerificationError, naming the session, if a sealed end belongs to another chain
void require_sealed_ends(const StudyEvents& events, const SessionKeys& keys);

/// Opens a trial's trace.
/// \param sealed  StudyStore::sealed_trace of the trial
/// \throws VerificationError, naming the trial, if the trace is missing or does not open
[[nodiscard]] record::Trace open_trace(const std::optional<record::SealedTrace>& sealed,
                                       const record::TrialRow& trial, const SessionKeys& keys);

/// Schedules and layouts of all sessions that are not erased, by session. Restarted blocks, in
/// their new order, follow the schedule with which the session began.
/// \throws VerificationError, naming the session, if a schedule does not open or does not belong to
///   this key
[[nodiscard]] std::map<int, study::Schedule> open_schedules(const StudyEvents& events,
                                                            const study::StudyKey& key,
                                                            const SessionKeys& keys);

}  // namespace touchtrial::analysis
