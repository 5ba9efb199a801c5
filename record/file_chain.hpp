/// \file The state of the study and its sessions, from the file's chain, and the check of sessions
///   against it.
#pragma once

#include "record/file_bodies.hpp"
#include "record/fold.hpp"
#include "record/sealing.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::record {

/// A recorded look at one participant's outcomes.
struct PersonLook {
  std::string participant;
  std::string reason;
  std::chrono::nanoseconds at{};  ///< UTC since 1970

  friend bool operator==(const PersonLook&, const PersonLook&) = default;
};

/// The state of data collection, from the file's chain.
struct StudyState {
  bool closed = false;
  bool unblinded = false;         ///< the study's outcomes may be shown (an interim look counts)
  std::string unblinding_reason;  ///< of the last unblinding of the study
  /// If the last unblinding was an interim look: the sessions that had ended before it.
  std::optional<std::set<int>> interim;
  /// If the last unblinding showed only the registered question: the sessions that had ended
  /// before it. The study then still counts as blind, except for the report of that question.
  std::optional<std::set<int>> question;

  std::vector<PersonLook> looks;  ///< looks at one participant each, in order
  std::set<int> looked_at;        ///< the sessions that these looks show

  /// Whether the study's results, or the answer to its registered question, include a session. An
  /// interim look excludes sessions that end after it.
  [[nodiscard]] bool reports(int session) const {
    if (question) return question->contains(session);
    return unblinded && (!interim || interim->contains(session));
  }
  /// Whether a session's outcomes may be shown, at least in a look at that participant.
  [[nodiscard]] bool shows(int session) const {
    return reports(session) || looked_at.contains(session);
  }
};

/// \param chain  the events of session 0
/// \throws EventFault if a body cannot be read
[[nodiscard]] StudyState state_of_chain(std::span<const Event> chain);

/// One session, from the file's chain.
struct SessionOnFile {
  SessionOpenedBody opened;
  std::optional<SessionClosedBody> closed;
  std::string replaced_by;  ///< empty: not replaced

  // Sequence numbers on the file's chain; of the last exclusion or withdrawal if there are several.
  std::int64_t opened_at = 0;
  std::optional<std::int64_t> closed_at;
  std::optional<std::int64_t> excluded_at;
  std::optional<std::int64_t> withdrawn_at;
  std::optional<std::int64_t> erased_at;         ///< the participant's key was destroyed
  std::chrono::nanoseconds erased_time{};        ///< UTC; meaningful with erased_at
  std::optional<std::int64_t> safety_erased_at;  ///< the safety key was destroyed
  std::optional<std::int64_t> replaced_at;

  /// The session's number in the file that it was recorded in.
  [[nodiscard]] int own_session() const noexcept {
    return opened.own_session > 0 ? opened.own_session : opened.session;
  }
  /// Whether it was replaced or withdrawn before it ended, so that it cannot continue.
  [[nodiscard]] bool is_cut_short() const noexcept {
    return !closed && (replaced_at || withdrawn_at);
  }
};

/// When participant ids and enrolment numbers must be unique, each with its visit.
enum class UniquePlaces {
  always,  ///< at every event, among sessions not yet replaced: a station's file
  at_end   ///< among sessions that were never replaced, which collected_chain ensures
};

/// The events of the file's chain in order, checked against each other. Links and hashes are not
/// checked here.
class FileChain {
 public:
  explicit FileChain(UniquePlaces unique = UniquePlaces::always) : unique_(unique) {}

  /// \throws EventFault if the event cannot follow the earlier ones
  void add(const Event& event);

  /// The study's commitment; empty only before the first event.
  [[nodiscard]] const std::optional<StudyCommitment>& commitment() const { return commitment_; }
  /// All sessions, by number.
  [[nodiscard]] const std::map<int, SessionOnFile>& sessions() const { return sessions_; }

 private:
  void open_session(const Event& event);
  void close_session(const Event& event);
  void exclude(const Event& event);
  void withdraw(const Event& event);
  void replace(const Event& event);
  [[nodiscard]] SessionOnFile& named_session(const Event& event);
  void reserve_place(const Event& event, const SessionOpenedBody& body);
  void require_previous_visit(const Event& event, const SessionOpenedBody& body) const;

  UniquePlaces unique_;
  std::optional<StudyCommitment> commitment_;
  std::map<int, SessionOnFile> sessions_;
  /// Places in use, each with its visit, of sessions that were not replaced.
  std::set<std::pair<std::string, int>> participants_;
  std::set<std::pair<int, int>> enrolments_;
  std::vector<Event> ends_and_looks_;  ///< these events decide whose outcomes were seen
  bool closed_ = false;
};

/// The valid signers of a file's chain: the file's station, and the investigator. Only the
/// investigator signs unblindings.
class Signatories {
 public:
  /// \param committed  the chain's first event
  /// \throws EventFault if it cannot be read, or the station lacks the investigator's signature
  explicit Signatories(const Event& committed);

  /// \throws EventFault if none of them signed the event
  void require(const Event& event) const;

 private:
  PublicKey investigator_;
  std::optional<PublicKey> station_;
};

/// A station's file chain with checked links, hashes, signatures, and consistency of its events.
/// \throws EventFault at the first fault
[[nodiscard]] FileChain checked_file_chain(std::span<const Event> chain);

/// The trace that a trace-stored event commits to.
struct TraceClaim {
  std::int64_t sequence = 0;  ///< of the event
  Digest digest{};
};

/// Checks one session against its file's chain, event by event. Every function throws EventFault,
/// naming the event, at the first fault.
class SessionCheck {
 public:
  /// \param session  its number in this file
  /// \param on_file, commitment  outlive this
  SessionCheck(int session, const SessionOnFile& on_file, const StudyCommitment& commitment);

  /// Adds the next event: checks its link, and whether the opening matches the file's chain.
  /// \param rows  updated
  void add(const Event& event, DerivedRows& rows);
  /// Checks the session's end against the file's chain. Call after the last event.
  void finish(const DerivedRows& rows) const;
  /// Checks that the stored keys match the opening, except for keys that were destroyed since.
  void check_keys(const WrappedKeys& stored) const;

  /// All traces that the events name, by trial.
  [[nodiscard]] const std::map<int, TraceClaim>& claims() const noexcept { return claims_; }

 private:
  void check_opening(const Event& event) const;
  void note_trace(const Event& event, const TraceBody& body);

  int session_;
  const SessionOnFile& on_file_;
  const StudyCommitment& commitment_;
  ChainLink chain_;
  std::map<int, TraceClaim> claims_;
};

}  // namespace touchtrial::record
