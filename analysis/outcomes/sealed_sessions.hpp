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

/// The key that encrypts a participant's payloads.
/// \return nothing if the key was erased
/// \throws VerificationError if the key is missing although nobody withdrew, or does not open
[[nodiscard]] std::optional<SecretKey> participant_key(const record::StudyStore& store,
                                                       const study::StudyKey& key,
                                                       const record::SessionRow& session);

/// The unerased keys of a session.
/// \throws VerificationError as participant_key does, for either key
[[nodiscard]] record::PersonKeys person_keys(const record::StudyStore& store,
                                             const study::StudyKey& key,
                                             const record::SessionRow& session);

/// The unerased keys by session. They are unwrapped once and shared by all readers of a study.
using SessionKeys = std::map<int, record::PersonKeys>;
/// \throws VerificationError as participant_key does
[[nodiscard]] SessionKeys person_keys(const record::StudyStore& store, const study::StudyKey& key);

/// Opens a session's event.
/// \param key  the participant's key
/// \throws VerificationError, naming the event, if it does not open
[[nodiscard]] record::OpenedEvent open_event(const record::Event& event, const SecretKey& key);
/// Opens an event of any chain with any remaining key.
/// \param row  the session that the event is about
/// \return the stored event if its key was erased
/// \throws VerificationError, naming the event, if it does not open
[[nodiscard]] record::Event readable_event(const record::Event& event,
                                           const record::SessionRow& row,
                                           const record::PersonKeys& keys);

/// Measures by session and number of the trial.
using Measures = std::map<std::pair<int, int>, record::TrialMeasures>;

/// The trials of all unerased sessions, with answers and times, by session and trial.
/// \throws VerificationError, naming the event, if an event does not open or contradicts earlier
///   events
[[nodiscard]] std::vector<record::TrialRow> open_trials(const record::StudyStore& store,
                                                        const SessionKeys& keys);

/// A study opened with its key. Reads, checks and opens every event once, in parallel over
/// sessions.
class OpenedSessions {
 public:
  /// \throws VerificationError if chains or derived tables are damaged (traces are not checked), or
  ///   as person_keys does
  OpenedSessions(const record::StudyStore& store, const study::StudyKey& key);
  ~OpenedSessions();
  OpenedSessions(const OpenedSessions&) = delete;
  OpenedSessions& operator=(const OpenedSessions&) = delete;

  [[nodiscard]] const SessionKeys& keys() const noexcept { return keys_; }
  /// The kept events (StudyEvents::is_kept), as stored.
  [[nodiscard]] const StudyEvents& events() const noexcept { return events_; }
  /// Like open_trials. Call at most once.
  /// \param measures  receives the measures of all trials with a trace; for a repeated trial, the
  ///   measures of the last presentation
  [[nodiscard]] std::vector<record::TrialRow> release_trials(Measures& measures);

 private:
  struct Session;

  std::map<int, Session> sessions_;
  SessionKeys keys_;
  StudyEvents events_;
};

/// Compares every ended, unerased session's chain with its sealed end. Without the key, a chain can
/// be rebuilt, but its end cannot be sealed.
/// \throws VerificationError, naming the session, if a sealed end belongs to another chain
void require_sealed_ends(const StudyEvents& events, const SessionKeys& keys);

/// Opens a trial's trace.
/// \param sealed  StudyStore::sealed_trace of the trial
/// \throws VerificationError, naming the trial, if the trace is missing or does not open
[[nodiscard]] record::Trace open_trace(const std::optional<record::SealedTrace>& sealed,
                                       const record::TrialRow& trial, const SessionKeys& keys);

/// Schedules and layouts of all unerased sessions, by session. Restarted blocks, in their new
/// order, follow the initial schedule.
/// \throws VerificationError, naming the session, if a schedule does not open or does not belong to
///   this key
[[nodiscard]] std::map<int, study::Schedule> open_schedules(const StudyEvents& events,
                                                            const study::StudyKey& key,
                                                            const SessionKeys& keys);

}  // namespace touchtrial::analysis
