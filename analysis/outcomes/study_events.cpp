#include "analysis/outcomes/study_events.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace touchtrial::analysis {

namespace {

/// Whether a report has no use for the kind but to open trials.
bool tells_of_trials(record::EventKind kind) {
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
  if (event.kind == record::EventKind::trace_stored) return names_servo(event);
  return !tells_of_trials(event.kind);
}

bool StudyEvents::names_servo(const record::Event& trace_stored) {
  return trace_stored.body.find("\"servo\"") != std::string::npos;
}

void StudyEvents::for_each_of(std::span<const record::EventKind> kinds,
                              const std::function<void(const record::Event&)>& visit) const {
  if (!kept_) return store_->for_each_of(kinds, visit);
  if (std::ranges::any_of(kinds, tells_of_trials)) {
    throw std::logic_error("events of trials are not kept; StudyEvents::is_kept has to name them");
  }
  for (const auto& [session, events] : *kept_) {
    for (const record::Event& event : events) {
      if (std::ranges::find(kinds, event.kind) != kinds.end()) visit(event);
    }
  }
}

}  // namespace touchtrial::analysis
