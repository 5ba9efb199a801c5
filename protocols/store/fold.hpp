/// \file What events come to: the rows of sessions, trials and responses. One function says so for
/// every use: as events arrive, when the tables are made anew, and when they are verified.
#pragma once

#include "protocols/store/event.hpp"
#include "protocols/store/study_store.hpp"

#include <map>
#include <optional>
#include <utility>

namespace touchtrial::store {

using TrialId = std::pair<int, int>;  ///< session, trial

/// Some or all derived rows. A TrialRow holds a row of trials and, if answered, one of responses.
struct DerivedRows {
  std::map<int, SessionRow> sessions;
  std::map<TrialId, TrialRow> trials;
};

/// Which rows an event is about; fold needs these and no others.
struct FoldScope {
  std::optional<int> session;
  std::optional<TrialId> trial;
  /// Session and block: all trials of it that were presented.
  std::optional<std::pair<int, int>> block{};
};

/// \throws EventFault if the event's body is no such
[[nodiscard]] FoldScope scope_of(const Event& event);

/// Brings `rows` up to date with one more event. Sessions may be folded in any order, the events of
/// each in theirs; the file's chain after the sessions that it names.
/// \throws EventFault if the event's body is no such, or it cannot come after those before: `rows`
///   are then as they were
void fold(DerivedRows& rows, const Event& event);

}  // namespace touchtrial::store
