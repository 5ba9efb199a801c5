/// \file A study in its database: what every operation of StudyStore is made of.
/// Private to protocols/store. Call everything here inside Database::run, and what writes inside a
/// write transaction.
#pragma once

#include "protocols/store/database.hpp"
#include "protocols/store/fold.hpp"
#include "protocols/store/payload_json.hpp"
#include "protocols/store/study_store.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace touchtrial::store {

class StoredStudy {
 public:
  explicit StoredStudy(Database opened) : database_(std::move(opened)) {}

  [[nodiscard]] const Database& database() const noexcept { return database_; }

  /// The first event's body; read once. \throws StoreError if there is none
  [[nodiscard]] const StudyCommitment& commitment() const;
  [[nodiscard]] StudyState state() const;
  /// Where a chain ends (0: the file's).
  [[nodiscard]] ChainHead head(int session) const;
  [[nodiscard]] std::optional<Event> last_event(int session) const;
  /// How many stations' files were collected into this one.
  [[nodiscard]] int stations() const;
  [[nodiscard]] int next_session() const;
  /// The smallest number that nobody has and that is kept for nobody.
  [[nodiscard]] int next_enrolment() const;
  /// What the participant inherits, else next_enrolment.
  [[nodiscard]] int enrolment_for(const std::string& participant) const;
  /// The session that a participant has and that nobody replaced, if any.
  [[nodiscard]] std::optional<SessionRow> session_of(const std::string& participant) const;
  /// \throws StoreError if there is no such session
  [[nodiscard]] SessionRow session(int session) const;

  /// Adds an event to the file's chain, and to the derived rows what it means.
  void append_to_file(EventKind kind, std::chrono::nanoseconds at, const std::string& body);
  /// Adds an event of a session, and to the derived rows what it means.
  void append(const Event& event, const std::optional<SealedTrace>& trace);

  /// Lets a session in: its key, and its opening on the file's chain.
  /// \throws StoreError if the study is closed, the session is not the next, belongs to another
  ///   study, or its participant or enrolment is taken (by which session), or it would mix pilots
  ///   with others or what is seen with what is felt
  void admit(const Event& opened, const Bytes& wrapped_key, std::chrono::nanoseconds at);
  /// The last event of a session that may go on.
  /// \throws StoreError if there is no such session, it is closed, its participant has withdrawn,
  ///   or the study is closed
  [[nodiscard]] Event last_of_open(int session) const;
  /// A session's end on the file's chain. \param closed  its last event
  void conclude(const Event& closed, std::chrono::nanoseconds at);

  /// Destroys a participant's key. \throws StoreError if they have withdrawn already
  void withdraw(int session, std::chrono::nanoseconds at, const std::string& reason);
  /// \throws StoreError if the session may still go on or was replaced, or `by` is taken
  void replace(const ReplacementBody& replacement, std::chrono::nanoseconds at);

  /// \throws StoreError with the file's name before `text`
  [[noreturn]] void refuse(const std::string& text) const;
  /// \throws StoreError naming `what` if `reason` is empty
  void require_reason(const std::string& reason, const std::string& what) const;

 private:
  void refuse_if_collected() const;
  void refuse_after_withdrawal(const DerivedRows& rows, const Event& event) const;
  void check_opening(const SessionOpening& opening) const;
  /// Pilots and others, what is seen and what is felt: one database holds one kind.
  void refuse_mixture(const SessionOpening& opening) const;
  void refuse_if_taken(const SessionOpening& opening) const;
  /// Nobody comes back whom somebody else replaced, nor takes a number that is kept for another.
  void refuse_if_promised(const SessionOpening& opening) const;
  void check_replaced(const SessionRow& row) const;
  void check_replacement(const SessionRow& row, const std::string& by) const;
  /// Numbers that are kept, and for whom.
  [[nodiscard]] std::map<int, std::string> promised_enrolments() const;

  Database database_;
  mutable std::optional<StudyCommitment> commitment_;
};

}  // namespace touchtrial::store
