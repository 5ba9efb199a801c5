/// \file The database of a study, one SQLite file: events, sealed traces and wrapped participant
/// keys; rows of sessions and trials are derived from events on demand. Each station has one;
/// several can be collected into one (record/merging/collect.hpp). Format: docs/data-dictionary.md,
/// "Database".
#pragma once

#include "record/file_chain.hpp"
#include "record/fold.hpp"
#include "record/head_file.hpp"
#include "record/session_recorder.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::record {

/// The extent of a check. `skip` omits the file's pages and the traces, which are nearly all of a
/// file, and most signatures: on each file's chain it checks those of unblindings and of the last
/// event, which vouches for the events before it.
enum class TraceCheck { full, skip };

/// Receives the events of one session, in order. Called concurrently on several threads, for
/// sessions in any order; must not throw or use the database.
using SessionReader = std::function<void(int session, std::vector<Event> events)>;

/// Whether a text may name a participant (kParticipantIdRule).
[[nodiscard]] bool is_participant_id(const std::string& id);
/// The remedy in messages about an invalid id.
inline constexpr std::string_view kParticipantIdRule =
    "use 1 to 32 of 0-9, A-Z, a-z, '+', '-', '_', not + or - in front, and no word that other "
    "programs take for a missing value, such as NA or TRUE";

/// A fault in the evidence, and its place.
struct ChainFault {
  int session = 0;  ///< as Event::session
  std::int64_t sequence = 0;
  std::string what;
};

/// UTC since 1970, for the events of the file's chain.
using UtcClock = std::function<std::chrono::nanoseconds()>;

/// The database. One writer at a time (SQLite's lock); not thread-safe.
class StudyStore {
 public:
  /// Creates a database with its first event. The file gets its name only when it is complete and
  /// synced.
  /// \param signer  the commitment's station, or its investigator; as sign_with
  /// \throws StoreError if the file exists or cannot be created
  [[nodiscard]] static StudyStore create(const std::filesystem::path& path,
                                         const StudyCommitment& commitment,
                                         std::chrono::nanoseconds at, const Signer& signer);

  enum class Access { read_only, read_write };

  /// Opens an existing database; another version is refused and left unchanged. Reading changes
  /// nothing (except that it checkpoints a log left by a crash), leaves no files behind, and sees
  /// what other programs write. A file without a -wal can be read in a read-only folder; other
  /// programs must not write to it then. Opening checks only what it reads; see first_fault.
  /// \throws DamagedStore if it is truncated, lacks tables or cannot be read by SQLite
  /// \throws StoreError if it is missing, not a Touchtrial database, or of another version
  [[nodiscard]] static StudyStore open(const std::filesystem::path& path, Access access);

  /// Sets the signer of all further events on the file's chain. Without one, functions that record
  /// there throw StoreError.
  /// \throws StoreError if the signer is neither the file's station nor its investigator
  void sign_with(const Signer& signer);

  /// From now on, `writer` receives the ends of the chains after each commit to the file's chain,
  /// and at a session's beginning and end, answers and pauses. Its exceptions are rethrown; the
  /// commit remains.
  /// \pre sign_with
  void set_head_writer(HeadWriter writer);

  /// Records that the database has a head file beside it, and one in another folder: from now on
  /// recorded head files are compared, and reported if missing.
  /// \param also  the other folder; empty: none
  /// \pre set_head_writer
  void record_heads(const std::string& also, std::chrono::nanoseconds at);
  /// The other folder on record; nothing: no head file is on record.
  [[nodiscard]] std::optional<std::string> heads_on_record() const;

  ~StudyStore();
  StudyStore(StudyStore&&) noexcept;
  StudyStore& operator=(StudyStore&&) noexcept;

  [[nodiscard]] const StudyCommitment& commitment() const;
  [[nodiscard]] StudyState state() const;
  /// The end of the file's chain.
  [[nodiscard]] ChainHead file_head() const;
  /// Empties the write-ahead log, which may still contain an erased key.
  /// \return false if another program prevented it
  [[nodiscard]] bool clear_log() const;
  /// Writes a copy of the current database to a path, replacing an existing file.
  /// \throws StoreError if another program blocks reading, or the copy cannot be written
  void copy_to(const std::filesystem::path& path) const;
  [[nodiscard]] std::vector<SessionRow> sessions() const;
  /// The participant's session, in any state, that was not replaced; the last one if there are
  /// several visits.
  [[nodiscard]] std::optional<SessionRow> session_of(const std::string& participant) const;
  /// All sessions of a participant, by number, including those before a restart.
  [[nodiscard]] std::vector<SessionRow> sessions_of(const std::string& participant) const;
  /// The last event of one chain (0: the file's). The events before it are not read.
  [[nodiscard]] std::optional<Event> last_event(int session) const;
  /// One event of a chain (0: the file's); nothing if there is none.
  [[nodiscard]] std::optional<Event> event_at(int session, std::int64_t sequence) const;
  /// The number of answers, including those of restarted blocks. Reads the kind of every event, so
  /// call it once before a session, and count during it.
  [[nodiscard]] std::int64_t answers() const;
  /// All trials of all sessions, by session and trial: without answers and times, which are sealed.
  /// Reads every event that is about a trial.
  [[nodiscard]] std::vector<TrialRow> trials() const;
  /// Events of one chain in order (0: the file's).
  [[nodiscard]] std::vector<Event> events(int session) const;
  /// Calls `visit` for every event of one kind in all sessions, by session and sequence.
  void for_each(EventKind kind, const std::function<void(const Event&)>& visit) const;
  /// The same for several kinds in one pass.
  void for_each_of(std::span<const EventKind> kinds,
                   const std::function<void(const Event&)>& visit) const;

  /// Stores a finished session in one transaction: its key, events and traces, and its opening
  /// and closing on the file's chain.
  /// \param keys  from wrap_participant_key
  /// \throws StoreError if participant or enrolment is already taken (the message names the
  ///   session), the previous visit is not complete, the study is closed, pilots and others or
  ///   screens and haptic devices would mix, or the chain is faulty; nothing is stored then
  void add_session(const BufferedEvents& session, const NewKeys& keys, std::chrono::nanoseconds at);

  /// Starts a session whose events are stored one by one, each in its own transaction. The file
  /// contains the session from its event `opened` on; storing that event throws as add_session.
  /// \param utc  the system's clock if empty
  /// \param kept_key  from seal_station_copy, erased when the session ends; empty: the session
  ///   cannot be resumed without the investigator's key
  /// \return the sink; it must not outlive the store
  [[nodiscard]] std::unique_ptr<EventSink> begin_session(int session, const NewKeys& keys,
                                                         UtcClock utc = {},
                                                         const Bytes& kept_key = {});

  /// Continues a stored, open session after the program ended during it. Pass the opened last_event
  /// to SessionRecorder::continue_after. If another program also continues it, the slower of the
  /// two is refused at its next event; see session_lock.hpp.
  /// \param utc  the system's clock if empty
  /// \return the sink; it must not outlive the store
  /// \throws StoreError if there is no such session, it has ended, its participant has withdrawn,
  ///   or the study is closed
  [[nodiscard]] std::unique_ptr<EventSink> continue_session(int session, UtcClock utc = {});

  /// The number that the next session gets.
  [[nodiscard]] int next_session() const;
  /// The smallest enrolment number, from 1, that is neither taken nor reserved.
  [[nodiscard]] int next_enrolment() const;
  /// This participant's number: inherited from the participant whom they replace or from their own
  /// restarted session, or else next_enrolment.
  [[nodiscard]] int enrolment_for(const std::string& participant) const;

  void close_study(std::chrono::nanoseconds at);
  /// \param interim  a look at the sessions that have ended, while the study continues
  /// \throws StoreError if the study is open and `interim` is false, if it is closed and `interim`
  ///   is true, or if `reason` is empty
  void unblind(std::chrono::nanoseconds at, const std::string& reason, bool interim);
  /// An interim look that shows only the answer to the registered question.
  /// \throws StoreError if the study is closed, or if `reason` is empty
  void look_at_question(std::chrono::nanoseconds at, const std::string& reason);
  /// A look at one participant's outcomes, during the study or after it. It shows the participant's
  /// sessions up to now.
  /// \throws StoreError if the participant has none, one of them may still continue, all are
  ///   erased, or `reason` is empty
  void look_at(const std::string& participant, std::chrono::nanoseconds at,
               const std::string& reason);

  // The reasons and texts that follow are sealed for the investigator (person_texts.hpp).

  /// Excludes a session from outcomes. Whether its outcomes had been seen is recorded unencrypted.
  /// \throws StoreError if there is no such session, it is already excluded, or `reason` is empty
  void exclude(int session, std::chrono::nanoseconds at, const std::string& reason);
  /// The participant leaves the study: an open session cannot continue. Destroys the keys of data
  /// that are not retained, which are then unreadable forever. The chain hashes ciphertext and
  /// stays valid. Copies of the file still contain the keys: destroy those yourself.
  /// \param not_erased  copies that this cannot reach; recorded unencrypted
  /// \throws StoreError if there is no such session, the same data or more were already withdrawn,
  ///   or the safety record would be erased before the data or before the study's years have
  ///   passed; also, after the withdrawal, if another program keeps a page with a key in the
  ///   write-ahead log
  void withdraw(int session, std::chrono::nanoseconds at, const std::string& reason,
                Retention kept = Retention::safety_record, const std::string& not_erased = "");
  /// The same for all sessions of one participant, atomically.
  void withdraw(std::span<const int> sessions, std::chrono::nanoseconds at,
                const std::string& reason, Retention kept = Retention::safety_record,
                const std::string& not_erased = "");

  /// Replaces a session's participant by `by`: the next session under that id inherits the
  /// enrolment number. The replaced session is unchanged, but excluded from outcomes. Another
  /// participant takes over all visits.
  /// \param by  another participant, or the same one, whose session is restarted
  /// \throws StoreError if there is no such session, it was already replaced or may still continue
  ///   (it must have been stopped, excluded or withdrawn), `by` already has a session or replaces
  ///   another participant or is not a participant id, the study is closed, or `reason` is empty
  void replace(int session, const std::string& by, std::chrono::nanoseconds at,
               const std::string& reason);

  /// A remark on a session, or a deviation from the protocol, at any time.
  /// \param code  of the deviation; empty: a remark
  /// \throws StoreError if there is no such session, or `text` and `code` are empty
  void note(int session, std::chrono::nanoseconds at, const std::string& code,
            const std::string& text);

  /// Records that the study continues despite a loss of data, with a deviation "answers-lost" in
  /// each affected session.
  /// \param sessions  the loss of each, sealed
  /// \throws StoreError if there is no such session, or the reason is empty
  void accept_loss(const LossBody& loss, const std::map<int, std::string>& sessions,
                   std::chrono::nanoseconds at);

  /// A session's remaining keys.
  [[nodiscard]] WrappedKeys wrapped_keys(int session) const;
  /// The participant's wrapped key, unless it was destroyed.
  [[nodiscard]] std::optional<Bytes> wrapped_key(int session) const;
  /// The station's copy of an open session's key; empty if there is none, or the session has ended.
  [[nodiscard]] std::optional<Bytes> kept_key(int session) const;
  [[nodiscard]] std::optional<SealedTrace> sealed_trace(int session, int trial) const;

  /// The number of stations' files that were collected into this one; 0: it is a station's file. A
  /// collected database accepts no sessions and replacements: those are recorded at the stations.
  [[nodiscard]] int stations() const;
  /// A station's file chain, as stored at the station.
  /// \param station  from 1
  [[nodiscard]] std::vector<Event> station_chain(int station) const;

  /// Recomputes every hash of every chain, and compares the file's chain with the sessions' heads
  /// and lengths, and stored traces with their events. It cannot detect events that were removed
  /// from the end of the file's chain, or of an open session.
  /// \return the first fault, or nothing
  /// \param reader  receives the events of every session with an intact chain, so that they need
  ///   not be read twice; they are valid only if no fault is found
  [[nodiscard]] std::optional<ChainFault> first_fault(TraceCheck traces = TraceCheck::full,
                                                      const SessionReader& reader = {}) const;

 private:
  struct Impl;
  static void fill(const std::filesystem::path& draft, const StudyCommitment& commitment,
                   std::chrono::nanoseconds at, const Signer& signer);
  explicit StudyStore(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Writes a copy of a study's current database to a path, for an archive, even while others write.
/// An existing file is replaced. If copying fails, no file of that name is left.
/// \throws StoreError if there is no such database, another program blocks reading, or the copy
///   cannot be written
void copy_database(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace touchtrial::record
