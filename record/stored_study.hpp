/// \file The implementation of StudyStore: a study in its database, sessions that are stored event
/// by event, and the check of all stored data. Private to record.
/// Call everything here inside Database::run, and functions that write inside StoredStudy::change.
#pragma once

#include "record/database.hpp"
#include "record/fold.hpp"
#include "record/session_recorder.hpp"
#include "record/study_store.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::record {

/// A session's keys as stored in a database. See sealing.hpp.
struct SessionKeys {
  NewKeys wrapped;     ///< for the investigator
  Bytes station_copy;  ///< while the session is open; may be empty
};

/// A commit's changes to head files, besides the end of the file's chain.
struct HeadUpdate {
  int session = 0;  ///< the session whose chain grew; 0: none
  bool ended = false;
  std::int64_t answers = 0;  ///< added by the commit
};

class StoredStudy {
 public:
  explicit StoredStudy(Database opened) : database_(std::move(opened)) {}

  [[nodiscard]] const Database& database() const noexcept { return database_; }

  /// The body of the first event, which is read only once.
  /// \throws StoreError if there is no first event
  [[nodiscard]] const StudyCommitment& commitment() const;
  [[nodiscard]] StudyState state() const;
  /// The end of a chain (0: the file's).
  [[nodiscard]] ChainHead head(int session) const;
  [[nodiscard]] std::optional<Event> last_event(int session) const;
  /// The number of stations' files that were collected into this one.
  [[nodiscard]] int stations() const;
  [[nodiscard]] int next_session() const;
  /// The smallest enrolment number that is neither taken nor reserved.
  [[nodiscard]] int next_enrolment() const;
  /// The enrolment number that the participant inherits, or else next_enrolment.
  [[nodiscard]] int enrolment_for(const std::string& participant) const;
  /// Every session's row, by number. Read once, updated by appended events, and read again when
  /// another program has written.
  [[nodiscard]] const std::map<int, SessionRow>& sessions() const;
  /// Every trial's row, by session and trial. Read again after an event of a session.
  [[nodiscard]] const std::vector<TrialRow>& trials() const;
  /// The participant's session of the last visit that was not replaced, if any.
  [[nodiscard]] std::optional<SessionRow> session_of(const std::string& participant) const;
  /// \throws StoreError if there is no such session
  [[nodiscard]] SessionRow session(int session) const;

  /// \throws StoreError if `signer` is neither the file's station nor its investigator
  void sign_with(const Signer& signer);
  /// Adds a signed event to the file's chain.
  /// \throws StoreError if there is no signer, or only the investigator may sign the event
  /// \throws EventFault if neither of the two signed the last event
  void append_to_file(EventKind kind, std::chrono::nanoseconds at, const std::string& body,
                      Bytes sealed = {});
  /// \param record  record_of this database
  void set_head_writer(HeadWriter writer, HeadRecord record);
  /// Passes a commit to the writer of head files, if there is one.
  void update_heads(const HeadUpdate& update);
  /// Does what append_to_file does, for an event about a person, whose texts are sealed.
  /// \param body  complete
  void append_about(int session, EventKind kind, std::chrono::nanoseconds at,
                    const std::string& body);
  /// Adds an event of a chain, and updates `sessions`.
  void append(const Event& event, const std::optional<SealedTrace>& trace);
  /// \throws StoreError if the event's participant has withdrawn or was replaced, unless the event
  ///   ends the session
  void refuse_after_withdrawal(const Event& event) const;

  /// Does what Database::change does; if it fails, drops the cached rows.
  template <typename Work>
  void change(Work&& work) {
    try {
      database_.change(std::forward<Work>(work));
    } catch (...) {
      drop_cache();
      throw;
    }
  }

  /// Admits a new session: stores its keys, and records its opening on the file's chain.
  /// \throws StoreError if the study is closed, the session is not the next, belongs to another
  ///   study, its participant or enrolment is taken (the message names the session), or it would
  ///   mix pilots with others or sessions on a screen with sessions with a haptic device
  void admit(const Event& opening_event, const SessionKeys& keys, std::chrono::nanoseconds at);
  /// The last event of a session that may continue.
  /// \throws StoreError if there is no such session, it is closed, its participant has withdrawn,
  ///   or the study is closed
  [[nodiscard]] Event last_event_of_open(int session) const;
  /// Records a session's end on the file's chain, and erases the station's copy of its key.
  /// \param closing_event  its last event
  /// \return whether there was a copy to erase
  bool conclude(const Event& closing_event, std::chrono::nanoseconds at);
  /// Checkpoints the log into the file, which limits the loss from a damaged log and removes pages
  /// with erased copies of keys. No effect if the disk fails or another program reads. Call it
  /// outside of `change`.
  void empty_log() const;

  /// Checks the events of a finished session against each other.
  /// \throws StoreError, EventFault
  void check_complete(const BufferedEvents& session) const;
  /// \pre check_complete found no fault
  void store_complete(const BufferedEvents& session, const NewKeys& keys,
                      std::chrono::nanoseconds at);

  /// Records a withdrawal, and destroys the keys of the data that it does not retain.
  /// \throws StoreError if the same data or more were already withdrawn, or the safety record must
  ///   not be erased yet
  void withdraw(const WithdrawalBody& withdrawal, std::chrono::nanoseconds at);
  /// \throws StoreError if the session may still continue or was replaced, or `by` is taken
  void replace(const ReplacementBody& replacement, std::chrono::nanoseconds at);

  /// \throws StoreError, always, with the file's name before `text`
  [[noreturn]] void refuse(const std::string& text) const;
  /// \throws StoreError naming `what` if `reason` is empty
  void require_reason(const std::string& reason, const std::string& what) const;

 private:
  /// Drops cached rows if another program has written.
  void refresh() const;
  void drop_cache() const;
  /// \throws StoreError if the study accepts no more sessions: it was collected, or is closed
  void require_open_study() const;
  void require_participant_id(const std::string& id) const;
  void require_signed(const Event& last) const;
  /// The first event about a session on the file's chain.
  [[nodiscard]] Event opening_on_file(int session) const;
  void require_retention_over(int session, std::chrono::nanoseconds at) const;
  void check_opening(const SessionOpening& opening) const;
  /// Refuses to mix pilots with others, or sessions on a screen with sessions with a haptic device.
  void refuse_mixture(const SessionOpening& opening) const;
  void refuse_if_taken(const SessionOpening& opening) const;
  /// Refuses a participant who was replaced by another, and a number that is reserved for another.
  void refuse_if_reserved(const SessionOpening& opening) const;
  void check_replaced(const SessionRow& row) const;
  void check_replacement(const SessionRow& row, const std::string& by) const;
  /// Reserved enrolment numbers, and for whom.
  [[nodiscard]] std::map<int, std::string> reserved_enrolments() const;

  Database database_;
  mutable std::optional<StudyCommitment> commitment_;
  mutable std::optional<DerivedRows> sessions_;  ///< without trials
  mutable std::optional<std::vector<TrialRow>> trials_;
  mutable std::int64_t read_version_ = 0;  ///< SQLite's data_version when they were read
  std::optional<Signer> signer_;
  HeadWriter head_writer_;
  HeadRecord head_record_;  ///< for a missing head file, with the answers so far
};

/// The durable sink: every event, or group of events, is one transaction.
class StoredSession final : public EventSink {
 public:
  /// \param study  must outlive this
  StoredSession(StoredStudy& study, int session, SessionKeys keys, UtcClock utc);
  /// Continues a stored, open session.
  /// \param last  its last event
  StoredSession(StoredStudy& study, const Event& last, UtcClock utc);

  void accept(const Event& event, const std::optional<SealedTrace>& trace) override;
  void accept_together(std::span<const RecordedEvent> events) override;

 private:
  StoredSession(StoredStudy& study, ChainLink chain, SessionKeys keys, UtcClock utc);
  void refuse_if_others_wrote(int session) const;
  /// \param rows  updated
  /// \return whether the station's copy of the session's key was erased
  bool store(const RecordedEvent& recorded, bool is_first, DerivedRows& rows);

  StoredStudy& study_;
  ChainLink chain_;
  DerivedRows rows_;  ///< the session's rows, which decide the possible next events
  SessionKeys keys_;
  UtcClock utc_;
};

/// Finds the first fault of a database. Checks, in this order: the file's structure, its chain,
/// every session's chain, the sessions against the file's chain, keys, traces, and the schema. Call
/// it inside a transaction.
/// \param traces  `skip` omits structure and traces
/// \param reader  receives every session with an intact chain; may be empty
[[nodiscard]] std::optional<ChainFault> find_first_fault(const Database& database,
                                                         TraceCheck traces,
                                                         const SessionReader& reader);

}  // namespace touchtrial::record
