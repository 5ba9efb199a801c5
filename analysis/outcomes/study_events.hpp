/// \file The events of a study's sessions by kind, from its database or from memory.
#pragma once

#include "record/study_store.hpp"

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// Each session's events in order, by session.
using EventsOfSessions = std::map<int, std::vector<record::Event>>;

/// Source of events by kind. Most events record presentations, answers and traces, which a report
/// reads once while it checks chains (OpenedSessions). The few other events can be kept in memory.
class StudyEvents {
 public:
  /// Reads the database each time.
  StudyEvents(const record::StudyStore& store) : store_(&store) {}  // NOLINT: implicit conversion
  /// \param kept  all events for which is_kept is true
  StudyEvents(const record::StudyStore& store, EventsOfSessions kept)
      : store_(&store), kept_(std::move(kept)) {}

  /// A trace-stored event is kept only if it has servo timing.
  [[nodiscard]] static bool is_kept(const record::Event& event);
  /// A cheap test that avoids parsing; traces of simulated sessions have no servo timing.
  [[nodiscard]] static bool has_servo(const record::Event& trace_stored);

  [[nodiscard]] const record::StudyStore& store() const noexcept { return *store_; }
  /// Calls `visit` for the events of these kinds, by session and sequence. If events are kept in
  /// memory, traces without servo timing are left out.
  /// \throws std::logic_error for a kind that is not kept
  void for_each_of(std::span<const record::EventKind> kinds,
                   const std::function<void(const record::Event&)>& visit) const;

 private:
  const record::StudyStore* store_;
  std::optional<EventsOfSessions> kept_;
};

}  // namespace touchtrial::analysis
