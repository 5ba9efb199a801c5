#include "analysis/outcomes/study_events.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace touchtrial::analysis {

namespace {

/// Whether reports need events of this kind only to open trials.
bool is_trial_kind(record::EventKind kind) {
  switch (kind) {
    case record::EventKind::presented:
    case record::EventKind::first_contact:
    case record::EventKind::answered:
    case record::EventKind::timed_out:
    case record::EventKind::explored_again:
    case record::EventKind::ticked:
      return true;
    default:
      return false;
  }
}

}  // namespace

bool StudyEvents::is_kept(const record::Event& event) {
  if (event.kind == record::EventKind::trace_stored) return has_servo(event);
  return !is_trial_kind(event.kind);
}

bool StudyEvents::has_servo(const record::Event& trace_stored) {
  return trace_stored.body.find("\"servo\"") != std::string::npos;
}

void StudyEvents::for_each_of(std::span<const record::EventKind> kinds,
                              const std::function<void(const record::Event&)>& visit) const {
  if (!kept_) return store_->for_each_of(kinds, visit);
  if (std::ranges::any_of(kinds, is_trial_kind)) {
    throw std::logic_error(
        "events of trials are not kept in memory; StudyEvents::is_kept must include them");
  }
  for (const auto& [session, events] : *kept_) {
    for (const record::Event& event : events) {
      if (std::ranges::find(kinds, event.kind) != kinds.end()) visit(event);
    }
  }
}

}  // namespace touchtrial::analysis
