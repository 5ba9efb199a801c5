/// \file One SQLite file a station and study: events, sealed traces, wrapped participant keys, and
/// tables derived from the events; or one that several stations' files were collected into
/// (protocols/store/collected_store.hpp). Format: docs/data-dictionary.md, "Database".
#pragma once

#include "core/cipher.hpp"
#include "protocols/store/event.hpp"
#include "protocols/store/payload.hpp"
#include "protocols/store/session_recorder.hpp"
#include "protocols/store/trace.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::store {

/// How a session stands, derived from its events.
enum class SessionState { open, completed, stopped };

struct SessionRow {
  int session = 0;  ///< from 1
  std::string participant;
  int enrolment = 0;
  SessionState state{};
  bool simulated = false;
  bool pilot = false;
  bool excluded = false;
  bool withdrawn = false;
  std::string device;
  /// Participant who took this one's place in the order of enrolment, the same one if the session
  /// was restarted; empty: nobody.
  std::string replaced_by{};
  /// The number in the file that it was recorded in (Event::own_session): participant keys and
  /// whatever is sealed are bound to it.
  int own_session = 0;
  int station = 0;  ///< that it was collected from, from 1; 0: recorded in this file

  friend bool operator==(const SessionRow&, const SessionRow&) = default;
};

/// How a trial ended, derived from its events. `voided`: its block was restarted, whatever it was
/// before; it is never presented again.
enum class TrialState { presented, answered, timed_out, interrupted, voided };

struct TrialRow {
  int session = 0;
  int trial = 0;  ///< from 1
  int block = 0;
  TrialState state{};
  std::chrono::nanoseconds presented_at{};
  std::optional<std::chrono::nanoseconds> contact_at;
  std::optional<std::chrono::nanoseconds> answered_at;
  std::optional<int> position;  ///< in the participant's layout; empty: no response
  std::optional<int> first_position;
  std::optional<int> confidence;
  bool valid = true;
  std::int64_t overruns = 0;
  std::int64_t samples = 0;
  double rate_hz = 0.0;
  int explorations = 1;  ///< of the last presentation

  friend bool operator==(const TrialRow&, const TrialRow&) = default;
};

/// What the file's chain says of the state of collection.
struct StudyState {
  bool closed = false;
  bool unblinded = false;         ///< outcomes may be shown (an interim look counts)
  std::string unblinding_reason;  ///< of the last unblinding
  /// If that was an interim look: the sessions that had ended before it.
  std::optional<std::set<int>> interim;

  /// Whether a session's outcomes may be shown: an interim look shows nothing of sessions that end
  /// after it.
  [[nodiscard]] bool shows(int session) const {
    return unblinded && (!interim || interim->contains(session));
  }
};

/// Where a chain ends.
struct ChainHead {
  std::int64_t length = 0;  ///< number of events
  Digest hash{};            ///< of the last; zeros if there is none

  friend bool operator==(const ChainHead&, const ChainHead&) = default;
};

/// How much of a study is looked at: reading the file's pages and its traces, nearly all of a file,
/// may be left out.
enum class TraceCheck { full, skip };

/// A broken link, named: chain, sequence, what does not hold.
struct ChainFault {
  int session = 0;  ///< 0: the file's chain; -1, -2, ...: that of station 1, 2, ...
  std::int64_t sequence = 0;
  std::string what;
};

/// Asks for the sealed trace of a session, by its number here, and trial; it may throw StoreError.
using TraceFetch = std::function<std::optional<SealedTrace>(int, int)>;

/// UTC since 1970; the file's chain is stamped with it.
using UtcClock = std::function<std::chrono::nanoseconds()>;

/// The database. One writer at a time (SQLite's lock); not to be shared between threads.
class StudyStore {
 public:
  /// Makes a new database with its first event. Refuses an existing file. The file appears under
  /// its name when it is whole and safe; a kill or a power cut before leaves none.
  /// \throws StoreError if the file exists or cannot be made
  [[nodiscard]] static StudyStore create(const std::filesystem::path& path,
                                         const StudyCommitment& commitment,
                                         std::chrono::nanoseconds at);

  enum class Access { read_only, read_write };

  /// Opens an existing database; one of another schema is refused untouched, unless this program
  /// knows how to bring it forward and may write. Reading changes nothing (but folds in a log that
  /// a crash left), leaves nothing beside the file, and sees what other programs write; a file
  /// without a -wal can be read where nothing can be written, but should not be written to then by
  /// anybody else. Only what opening takes is looked at: see first_fault.
  /// \throws DamagedStore if it is truncated, lacks tables or cannot be read by SQLite
  /// \throws StoreError if it is missing, no Touchtrial database, or of another schema
  [[nodiscard]] static StudyStore open(const std::filesystem::path& path, Access access);

  ~StudyStore();
  StudyStore(StudyStore&&) noexcept;
  StudyStore& operator=(StudyStore&&) noexcept;

  [[nodiscard]] const StudyCommitment& commitment() const;
  [[nodiscard]] StudyState state() const;
  /// Where the file's chain ends.
  [[nodiscard]] ChainHead file_head() const;
  [[nodiscard]] std::vector<SessionRow> sessions() const;
  /// The session that this participant has and that nobody replaced, whatever its state.
  [[nodiscard]] std::optional<SessionRow> session_of(const std::string& participant) const;
  /// All that this participant ever had, by number: those before a restart too.
  [[nodiscard]] std::vector<SessionRow> sessions_of(const std::string& participant) const;
  /// The same if that session is still open: it may be continued.
  [[nodiscard]] std::optional<SessionRow> open_session_of(const std::string& participant) const;
  /// The last event of one chain (0: the file's), read without those before it.
  [[nodiscard]] std::optional<Event> last_event(int session) const;
  /// All trials of all sessions, by session and trial.
  [[nodiscard]] std::vector<TrialRow> trials() const;
  /// Events of one chain in order (0: the file's).
  [[nodiscard]] std::vector<Event> events(int session) const;
  /// Calls `visit` for every event of one kind in all sessions, by session and sequence.
  void for_each(EventKind kind, const std::function<void(const Event&)>& visit) const;
  /// The same of several kinds in one pass.
  void for_each_of(std::span<const EventKind> kinds,
                   const std::function<void(const Event&)>& visit) const;

  /// Stores a finished session in one transaction: its key, events and traces, its opening and
  /// closing on the file's chain, and its derived rows.
  /// \param wrapped_key  wrap_participant_key's result
  /// \throws StoreError if participant or enrolment is already taken (by which session), the study
  ///   is closed, the session is a pilot and the study not (or the other way round), its device is
  ///   seen and others' are felt, or the chain does not hold; nothing is stored then
  void add_session(const BufferedEvents& session, const Bytes& wrapped_key,
                   std::chrono::nanoseconds at);

  /// Starts a session whose events are stored one by one, each in its own transaction; it stands in
  /// the file from its `opened` on. Whoever asks in vain learns it from that event.
  /// \param utc  the system's clock if empty
  /// \return the sink; it must not outlive the store. Same errors as add_session.
  [[nodiscard]] std::unique_ptr<EventSink> begin_session(int session, const Bytes& wrapped_key,
                                                         UtcClock utc = {});

  /// Goes on with a session that is stored and still open, after the program ended in it. Give
  /// the recorder last_event (SessionRecorder::go_on_after). If another program goes on with it as
  /// well, the slower of the two is refused at its next event; see session_lock.hpp.
  /// \param utc  the system's clock if empty
  /// \return the sink; it must not outlive the store
  /// \throws StoreError if there is no such session, it has ended, its participant has withdrawn,
  ///   or the study is closed
  [[nodiscard]] std::unique_ptr<EventSink> continue_session(int session, UtcClock utc = {});

  /// The number that the next session gets.
  [[nodiscard]] int next_session() const;
  /// The smallest enrolment number that nobody has and that is kept for nobody, from 1.
  [[nodiscard]] int next_enrolment() const;
  /// The number that this participant gets: what they inherit from somebody whom they replace, or
  /// from their own session if it was restarted, else next_enrolment.
  [[nodiscard]] int enrolment_for(const std::string& participant) const;

  void close_study(std::chrono::nanoseconds at);
  /// \param interim  a look at the sessions that have ended, while the study goes on
  /// \throws StoreError if the study is open and `interim` is false or it is closed and `interim`
  /// is
  ///   true, or `reason` is empty
  void unblind(std::chrono::nanoseconds at, const std::string& reason, bool interim);

  /// Marks a session as left out of outcomes. \throws StoreError if there is no such session, it is
  /// already excluded, or `reason` is empty
  void exclude(int session, std::chrono::nanoseconds at, const std::string& reason);
  /// Destroys the participant's key, and with it every sealed payload, for ever; the chain, which
  /// hashes ciphertext, still holds. Copies of the file keep the key: destroy those yourself.
  /// \throws StoreError if there is no such session or it has already withdrawn; also, after the
  ///   withdrawal, if another program keeps the key's last traces in the write-ahead log
  void withdraw(int session, std::chrono::nanoseconds at, const std::string& reason);
  /// The same of several sessions, all or none: those of one participant.
  void withdraw(std::span<const int> sessions, std::chrono::nanoseconds at,
                const std::string& reason);

  /// Lets `by` take the place of a session's participant: whoever comes under that id next inherits
  /// the enrolment number. The session stays as it is, but enters no outcomes.
  /// \param by  another participant, or the same one, whose session is restarted
  /// \throws StoreError if there is no such session, it was replaced already or may still go on
  ///   (it must have been stopped, excluded or withdrawn), `by` has a session or replaces somebody
  ///   else already or is no participant id, the study is closed, or `reason` is empty
  void replace(int session, const std::string& by, std::chrono::nanoseconds at,
               const std::string& reason);

  /// A remark on a session, or a deviation from the protocol, at any time.
  /// \param code  of the deviation; empty: a remark
  /// \throws StoreError if there is no such session, or `text` and `code` are empty
  void note(int session, std::chrono::nanoseconds at, const std::string& code,
            const std::string& text);

  /// The participant's wrapped key; empty after withdrawal.
  [[nodiscard]] std::optional<Bytes> wrapped_key(int session) const;
  /// \throws StoreError if the trace must be fetched from elsewhere, in vain
  [[nodiscard]] std::optional<SealedTrace> sealed_trace(int session, int trial) const;

  /// How many stations' files were collected into this one; 0: it is a station's own. What was
  /// collected takes no sessions and no replacements: those are recorded at the stations.
  [[nodiscard]] int stations() const;
  /// A station's file chain as it stood in its own file. \param station  from 1
  [[nodiscard]] std::vector<Event> station_chain(int station) const;

  /// Recomputes every hash of every chain, holds the file's chain against the sessions' heads and
  /// lengths, stored traces against their events, and the derived tables against the events. What a
  /// chain cannot show: events cut off the end of the file's chain, or of a session that is still
  /// open.
  /// \param traces  `skip`: neither the pages of the file nor its traces are looked at
  /// \return the first fault, or nothing
  [[nodiscard]] std::optional<ChainFault> first_fault(TraceCheck traces = TraceCheck::full) const;

  /// Makes the derived tables anew from the events.
  void rebuild_derived();

 private:
  struct Impl;
  static void fill_new(const std::filesystem::path& draft, const StudyCommitment& commitment,
                       std::chrono::nanoseconds at);
  friend class CollectedDraft;
  explicit StudyStore(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A participant's random key, encrypted under the study's. Destroying the row that holds it makes
/// the participant's payloads unreadable for ever.
/// \param own_session  the session's own number, see SessionRow
[[nodiscard]] Bytes wrap_participant_key(const SecretKey& study_master, int own_session,
                                         const SecretKey& participant_key);
/// \return nothing if the bytes are no such key, or another session's
[[nodiscard]] std::optional<SecretKey> unwrap_participant_key(const SecretKey& study_master,
                                                              int own_session,
                                                              const Bytes& wrapped);

/// The secret text of an event (schedule, measures), or nothing if key or bytes are wrong.
[[nodiscard]] std::optional<std::string> unsealed(const Event& event,
                                                  const SecretKey& participant_key);
/// \param own_session  the session's own number, see SessionRow
[[nodiscard]] std::optional<Trace> unsealed_trace(int own_session, int trial, const Bytes& box,
                                                  const SecretKey& participant_key,
                                                  std::size_t sample_count);
[[nodiscard]] std::optional<Trace> unsealed_trace(const SealedTrace& sealed,
                                                  const SecretKey& participant_key,
                                                  std::size_t sample_count);
/// TrialMeasures from the secret text of a trace_stored event.
/// \throws StoreError if the text is not such
[[nodiscard]] TrialMeasures measures_from_json(const std::string& text);

}  // namespace touchtrial::store
