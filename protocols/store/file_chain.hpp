/// \file What the file's chain says of the study and its sessions.
#pragma once

#include "protocols/store/event.hpp"
#include "protocols/store/payload_json.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace touchtrial::store {

/// One session as the file's chain knows it.
struct SessionOnFile {
  SessionOpenedBody opened;
  std::int64_t opened_at = 0;  ///< sequence on the file's chain
  std::optional<SessionClosedBody> closed;
  bool withdrawn = false;
  std::string replaced_by;  ///< empty: nobody
};

/// Where a session's participant id and enrolment number must be nobody else's.
enum class UniquePlaces {
  always,     ///< at every moment, among sessions that nobody has replaced: a station's own file
  in_the_end  ///< among sessions that nobody replaced in the end, which collected_chain sees to
};

/// The events of the file's chain in order, held against each other.
class FileChain {
 public:
  explicit FileChain(UniquePlaces unique = UniquePlaces::always) : unique_(unique) {}

  /// \throws EventFault if the event cannot come after those before
  void add(const Event& event);

  /// Empty only before the first event.
  [[nodiscard]] const std::optional<StudyCommitment>& commitment() const { return commitment_; }
  [[nodiscard]] const std::map<int, SessionOnFile>& sessions() const { return sessions_; }

 private:
  void commit(const Event& event);
  void open_session(const Event& event);
  void close_session(const Event& event);
  void withdraw(const Event& event);
  void replace(const Event& event);
  [[nodiscard]] SessionOnFile& known(const Event& event, int session);
  void take_place(const Event& event, const SessionOpenedBody& body);

  UniquePlaces unique_;
  std::optional<StudyCommitment> commitment_;
  std::map<int, SessionOnFile> sessions_;
  /// Of sessions that nobody replaced.
  std::set<std::string> participants_;
  std::set<int> enrolments_;
  bool closed_ = false;
};

}  // namespace touchtrial::store
