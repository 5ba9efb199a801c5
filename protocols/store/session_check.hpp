/// \file One session held against what its file's chain says of it. Private to protocols/store.
#pragma once

#include "protocols/store/chain_link.hpp"
#include "protocols/store/event.hpp"
#include "protocols/store/file_chain.hpp"
#include "protocols/store/fold.hpp"

#include <cstdint>
#include <map>
#include <optional>

namespace touchtrial::store {

/// What a trace-stored event says of its trace.
struct TraceClaim {
  std::int64_t sequence = 0;
  Digest digest{};
};

/// Takes a session's events one by one. Every function throws EventFault, naming the event, at the
/// first thing that does not hold.
class SessionCheck {
 public:
  /// \param session  its number here  \param on_file, commitment  outlive this
  SessionCheck(int session, const SessionOnFile& on_file, const StudyCommitment& commitment);

  /// The next event: its link, whether the opening is the one on the file's chain, and what it
  /// comes to. \param rows  is brought up to date
  void add(const Event& event, DerivedRows& rows);
  /// After the last event: whether the session ends as the file's chain says.
  void finish(const DerivedRows& rows) const;
  /// \param wrapped  SHA-256 of the stored key, or nothing if there is none
  void check_key(const std::optional<Digest>& wrapped) const;

  /// Of all traces that the events name, by trial.
  [[nodiscard]] const std::map<int, TraceClaim>& claims() const noexcept { return claims_; }

 private:
  void check_opening(const Event& event) const;
  void note_trace(const Event& event);

  int session_;
  const SessionOnFile& on_file_;
  const StudyCommitment& commitment_;
  ChainLink chain_;
  std::map<int, TraceClaim> claims_;
};

/// The number that a session has in the file that it was recorded in.
[[nodiscard]] inline int own_session_of(const SessionOpenedBody& opened) {
  return opened.own_session > 0 ? opened.own_session : opened.session;
}

}  // namespace touchtrial::store
