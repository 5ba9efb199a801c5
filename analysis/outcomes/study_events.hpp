/// \file The events of a study's sessions by kind, from its database or kept in memory.
#pragma once

#include "record/study_store.hpp"

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// Events by session, each session's in order.
using EventsOfSessions = std::map<int, std::vector<record::Event>>;

/// Most events tell of presentations, answers and traces, and a report reads those once, with the
/// check of their chains (OpenedSessions). All others that a session has are few, and can be kept.
class StudyEvents {
 public:
  /// Reads the database each time.
  StudyEvents(const record::StudyStore& store) : store_(&store) {}  // NOLINT: stands for its events
  /// \param kept  all events that is_kept names
  StudyEvents(const record::StudyStore& store, EventsOfSessions kept)
      : store_(&store), kept_(std::move(kept)) {}

  /// A trace-stored event is kept only if it tells of a servo.
  [[nodiscard]] static bool is_kept(const record::Event& event);
  /// Most traces come from simulated sessions; a body that names no servo need not be parsed.
  [[nodiscard]] static bool names_servo(const record::Event& trace_stored);

  [[nodiscard]] const record::StudyStore& store() const noexcept { return *store_; }
  /// Calls `visit` for the events of these kinds, by session and sequence. Of traces, kept events
  /// are those that tell of a servo.
  /// \throws std::logic_error for a kind that is not kept
  void for_each_of(std::span<const record::EventKind> kinds,
                   const std::function<void(const record::Event&)>& visit) const;

 private:
  const record::StudyStore* store_;
  std::optional<EventsOfSessions> kept_;
};

}  // namespace touchtrial::analysis
