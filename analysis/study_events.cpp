#include "analysis/study_events.hpp"

#include <algorithm>
#include <string>

namespace touchtrial::analysis {

bool StudyEvents::is_kept(const store::Event& event) {
  switch (event.kind) {
    case store::EventKind::presented:
    case store::EventKind::first_contact:
    case store::EventKind::answered:
    case store::EventKind::timed_out:
    case store::EventKind::explored_again:
    case store::EventKind::ticked:
      return false;
    case store::EventKind::trace_stored:
      return event.body.find("\"servo\"") != std::string::npos;
    default:
      return true;
  }
}

void StudyEvents::for_each_of(std::span<const store::EventKind> kinds,
                              const std::function<void(const store::Event&)>& visit) const {
  if (!kept_) return store_->for_each_of(kinds, visit);
  for (const auto& [session, events] : *kept_) {
    for (const store::Event& event : events) {
      if (std::ranges::find(kinds, event.kind) != kinds.end()) visit(event);
    }
  }
}

}  // namespace touchtrial::analysis
