/// \file Events as they were recorded, with their times and whole bodies.
#pragma once

#include "core/errors.hpp"
#include "record/sealing.hpp"

#include <optional>
#include <vector>

namespace touchtrial {

/// \param event  of a session, as it is stored
inline record::Event as_recorded(const record::Event& event, const SecretKey& participant_key) {
  std::optional<record::OpenedEvent> opened = record::opened_event(event, participant_key);
  if (!opened) throw VerificationError("an event does not open");
  return opened->event;
}

inline std::vector<record::Event> as_recorded(const std::vector<record::Event>& events,
                                              const SecretKey& participant_key) {
  std::vector<record::Event> recorded;
  for (const record::Event& event : events) recorded.push_back(as_recorded(event, participant_key));
  return recorded;
}

}  // namespace touchtrial
