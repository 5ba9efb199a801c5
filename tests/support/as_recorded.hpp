/// \file Events as they were recorded, with their times and whole bodies.
#pragma once

#include "core/errors.hpp"
#include "protocols/store/sealing.hpp"

#include <optional>
#include <vector>

namespace touchtrial {

/// \param event  of a session, as it is stored
inline store::Event as_recorded(const store::Event& event, const SecretKey& participant_key) {
  std::optional<store::OpenedEvent> opened = store::opened_event(event, participant_key);
  if (!opened) throw VerificationError("an event does not open");
  return opened->event;
}

inline std::vector<store::Event> as_recorded(const std::vector<store::Event>& events,
                                             const SecretKey& participant_key) {
  std::vector<store::Event> recorded;
  for (const store::Event& event : events) recorded.push_back(as_recorded(event, participant_key));
  return recorded;
}

}  // namespace touchtrial
