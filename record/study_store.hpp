/// \file The database of a study, one SQLite file: events, sealed traces and wrapped participant
/// keys; what the events come to is worked out as it is asked for. Each station has one; several
/// can be collected into one (record/merging/collect.hpp). Format: docs/data-dictionary.md,
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

/// How much of a database is checked. `skip` leaves out the file's pages and the traces, which are
/// nearly all of a file, and most signatures: of each file's chain it checks those of the last
/// event, which vouches for the events before it, and of unblindings.
enum class TraceCheck { full, skip };

/// Takes the events of one session, in order. Called for several sessions at once, on several
/// threads, and in any order of sessions; must not throw or use the database.
using SessionReader = std::function<void(int session, std::vector<Event> events)>;

/// Whether a text may name a participant (kParticipantIdRule).
[[nodiscard]] bool is_participant_id(const std::string& id);
/// What a message says of an id that is none.
inline constexpr std::string_view kParticipantIdRule =
    "use 1 to 32 of 0-9, A-Z, a-z, '+', '-', '_', not + or - in front, and no word that other "
    "programs take for a missing value, such as NA or TRUE";

/// A fault of the evidence, and its place.
struct ChainFault {
  int session = 0;  ///< as Event::session
  std::int64_t sequence = 0;
  std::string what;
};

/// UTC since 1970, for the events of the file's chain.
using UtcClock = std::function<std::chrono::nanoseconds()>;

/// The database. One writer at a time (SQLite's lock); not to be shared between threads.
class StudyStore {
 public:
  /// Makes a new database with its first event. The file appears under its name when it is whole
  /// and synced; a kill or a power cut before that leaves no file of this name.
  /// \param signer  the commitment's station, or its investigator; as sign_with
  /// \throws StoreError if the file exists or cannot be made
  [[nodiscard]] static StudyStore create(const std::filesystem::path& path,
                                         const StudyCommitment& commitment,
                                         std::chrono::nanoseconds at, const Signer& signer);

  enum class Access { read_only, read_write };

  /// Opens an existing database. One of another version is refused untouched. Reading changes
  /// nothing (except that it folds in a log left by a crash), leaves nothing beside the file, and
  /// sees what other programs write. A file without a -wal can be read in a folder that cannot be
  /// written; other programs should not write to it then. Opening checks only what it reads: see
  /// first_fault.
  /// \throws DamagedStore if it is truncated, lacks tables or cannot be read by SQLite
  /// \throws StoreError if it is missing, no Touchtrial database, or of another version
  [[nodiscard]] static StudyStore open(const std::filesystem::path& path, Access access);

  /// Whose signature stands under all that is recorded on the file's chain from now on. Functions
  /// that record there throw StoreError before.
  /// \throws StoreError if neither the file's station nor its investigator signs so
  void sign_with(const Signer& signer);

  /// From now on `keeper` gets the ends of the chains after each commit to the file's chain, and of
  /// a session after each answer, each pause, and its beginning and end. What it throws comes
  /// through; what was committed stays.
  /// \pre sign_with
  void keep_heads(HeadKeeper keeper);

  /// Records that the database has a head file beside it, and one in another folder: what is on
  /// record is compared from now on, and missed where it is gone.
  /// \param also  the other folder; empty: none
  /// \pre keep_heads
  void record_heads(const std::string& also, std::chrono::nanoseconds at);
  /// The other folder that is on record; nothing: no head file is.
  [[nodiscard]] std::optional<std::string> heads_on_record() const;

  ~StudyStore();
  StudyStore(StudyStore&&) noexcept;
  StudyStore& operator=(StudyStore&&) noexcept;

  [[nodiscard]] const StudyCommitment& commitment() const;
  [[nodiscard]] StudyState state() const;
  /// The end of the file's chain.
  [[nodiscard]] ChainHead file_head() const;
  /// Empties the write-ahead log, where a key that was erased lies until then.
  /// \return whether no other program prevented it
  [[nodiscard]] bool clear_log() const;
  /// Lays a copy of the database as it is now at a path; an existing file is replaced.
  /// \throws StoreError if another program keeps it from being read, or the copy cannot be written
  void copy_to(const std::filesystem::path& path) const;
  [[nodiscard]] std::vector<SessionRow> sessions() const;
  /// The participant's session that nobody replaced, whatever its state; of several visits, the
  /// last one's.
  [[nodiscard]] std::optional<SessionRow> session_of(const std::string& participant) const;
  /// All sessions of a participant, by number, including those before a restart.
  [[nodiscard]] std::vector<SessionRow> sessions_of(const std::string& participant) const;
  /// The last event of one chain (0: the file's). The events before it are not read.
  [[nodiscard]] std::optional<Event> last_event(int session) const;
  /// One event of a chain (0: the file's), by its place in it, from 0; nothing if it has none
  /// there.
  [[nodiscard]] std::optional<Event> event_at(int session, std::int64_t sequence) const;
  /// How many answers the database holds, those of restarted blocks included. Reads the kind of
  /// every event: count on from it during a session.
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
  /// \param keys  wrap_participant_key's result
  /// \throws StoreError if participant or enrolment is already taken (by which session), a later
  ///   visit follows no complete one, the study is closed, the session is a pilot and the study not
  ///   (or the other way round), its device is seen and others' are felt, or the chain does not
  ///   hold; nothing is stored then
  void add_session(const BufferedEvents& session, const NewKeys& keys, std::chrono::nanoseconds at);

  /// Starts a session whose events are stored one by one, each in its own transaction. The file
  /// holds the session from its event `opened` on; storing that event throws the errors of
  /// add_session.
  /// \param utc  the system's clock if empty
  /// \param kept_key  keep_participant_key's result, erased when the session ends; empty: the
  ///   session cannot be resumed without the investigator's key
  /// \return the sink; it must not outlive the store
  [[nodiscard]] std::unique_ptr<EventSink> begin_session(int session, const NewKeys& keys,
                                                         UtcClock utc = {},
                                                         const Bytes& kept_key = {});

  /// Goes on with a session that is stored and still open, after the program ended during it. Give
  /// last_event, opened, to the recorder (SessionRecorder::go_on_after). If another program goes on
  /// with it, the slower of the two is refused at its next event; see session_lock.hpp.
  /// \param utc  the system's clock if empty
  /// \return the sink; it must not outlive the store
  /// \throws StoreError if there is no such session, it has ended, its participant has withdrawn,
  ///   or the study is closed
  [[nodiscard]] std::unique_ptr<EventSink> continue_session(int session, UtcClock utc = {});

  /// The number that the next session gets.
  [[nodiscard]] int next_session() const;
  /// The smallest enrolment number, from 1, that is neither taken nor kept for somebody.
  [[nodiscard]] int next_enrolment() const;
  /// The number that this participant gets: inherited from the participant whom they replace or
  /// from their own restarted session, else next_enrolment.
  [[nodiscard]] int enrolment_for(const std::string& participant) const;

  void close_study(std::chrono::nanoseconds at);
  /// \param interim  a look at the sessions that have ended, while the study goes on
  /// \throws StoreError if the study is open and `interim` is false, if it is closed and `interim`
  ///   is true, or if `reason` is empty
  void unblind(std::chrono::nanoseconds at, const std::string& reason, bool interim);
  /// An interim look at the answer to the registered question, which shows nothing else.
  /// \throws StoreError if the study is closed, or if `reason` is empty
  void look_at_question(std::chrono::nanoseconds at, const std::string& reason);
  /// A look at one participant's outcomes, while the study is open or after. It shows the sessions
  /// that the participant has had so far.
  /// \throws StoreError if the participant has none, one of them may still go on, all are erased,
  ///   or `reason` is empty
  void look_at(const std::string& participant, std::chrono::nanoseconds at,
               const std::string& reason);

  // The reasons and texts that follow are sealed for the investigator (person_texts.hpp).

  /// Marks a session as left out of outcomes. Whether they had been seen is recorded in clear.
  /// \throws StoreError if there is no such session, it is already excluded, or `reason` is empty
  void exclude(int session, std::chrono::nanoseconds at, const std::string& reason);
  /// The participant takes no further part: a session that is open cannot go on. Destroys the keys
  /// of what is not kept, so that nobody can ever read it again. The chain, which hashes
  /// ciphertext, still holds. Copies of the file keep the keys: destroy those yourself.
  /// \param not_erased  what this cannot reach; recorded in clear
  /// \throws StoreError if there is no such session, no more is kept already, or the safety record
  ///   is to be erased before the data or before the study's years have passed; also, after the
  ///   withdrawal, if another program keeps a page with a key in the write-ahead log
  void withdraw(int session, std::chrono::nanoseconds at, const std::string& reason,
                Kept kept = Kept::safety_record, const std::string& not_erased = "");
  /// The same for all sessions of one participant: all of them or none.
  void withdraw(std::span<const int> sessions, std::chrono::nanoseconds at,
                const std::string& reason, Kept kept = Kept::safety_record,
                const std::string& not_erased = "");

  /// Lets `by` take the place of a session's participant: the next session under that id inherits
  /// the enrolment number. The replaced session stays as it is, but enters no outcomes. Another
  /// participant takes the place at all visits.
  /// \param by  another participant, or the same one, whose session is restarted
  /// \throws StoreError if there is no such session, it was replaced already or may still go on (it
  ///   must have been stopped, excluded or withdrawn), `by` has a session or replaces somebody else
  ///   already or is no participant id, the study is closed, or `reason` is empty
  void replace(int session, const std::string& by, std::chrono::nanoseconds at,
               const std::string& reason);

  /// A remark on a session, or a deviation from the protocol, at any time.
  /// \param code  of the deviation; empty: a remark
  /// \throws StoreError if there is no such session, or `text` and `code` are empty
  void note(int session, std::chrono::nanoseconds at, const std::string& code,
            const std::string& text);

  /// Records that the study goes on without what the database lost, and notes it as a deviation
  /// "answers-lost" of the sessions concerned.
  /// \param sessions  what each of them lost, sealed
  /// \throws StoreError if there is no such session, or the reason is empty
  void accept_loss(const LossBody& loss, const std::map<int, std::string>& sessions,
                   std::chrono::nanoseconds at);

  /// A session's keys, as far as they were not destroyed.
  [[nodiscard]] WrappedKeys wrapped_keys(int session) const;
  /// The participant's wrapped key alone.
  [[nodiscard]] std::optional<Bytes> wrapped_key(int session) const;
  /// The station's copy of an open session's key; empty if there is none, or the session has ended.
  [[nodiscard]] std::optional<Bytes> kept_key(int session) const;
  [[nodiscard]] std::optional<SealedTrace> sealed_trace(int session, int trial) const;

  /// How many stations' files were collected into this one; 0: it is a station's own. A collected
  /// database takes no sessions and no replacements: those are recorded at the stations.
  [[nodiscard]] int stations() const;
  /// A station's file chain as it stood in its own file.
  /// \param station  from 1
  [[nodiscard]] std::vector<Event> station_chain(int station) const;

  /// Recomputes every hash of every chain, and holds the file's chain against the sessions' heads
  /// and lengths, and stored traces against their events. It cannot find events that were cut off
  /// the end of the file's chain, or of an open session.
  /// \return the first fault, or nothing
  /// \param reader  gets the events of every session whose chain is intact, so that who needs them
  ///   as well reads them with the check; what it was given counts only if no fault is found
  [[nodiscard]] std::optional<ChainFault> first_fault(TraceCheck traces = TraceCheck::full,
                                                      const SessionReader& reader = {}) const;

 private:
  struct Impl;
  static void fill_new(const std::filesystem::path& draft, const StudyCommitment& commitment,
                       std::chrono::nanoseconds at, const Signer& signer);
  explicit StudyStore(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Lays a copy of a study's database at a path, for an archive: the database as it is now, while
/// others may go on writing. An existing file is replaced. If the copying breaks off, no file of
/// that name is left.
/// \throws StoreError if there is no such database, another program keeps it from being read, or
///   the copy cannot be written
void copy_database(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace touchtrial::record
