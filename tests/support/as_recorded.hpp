/// \file Stored events with their times and bodies decrypted.
#pragma once

#include "core/errors.hpp"
#include "record/sealing.hpp"

#include <optional>
#include <vector>

namespace touchtrial {

/// \param event  a session's event as stored
/// \throws VerificationError if the key does not open it
inline record::Event as_recorded(const record::Event& event, const SecretKey& participant_key) {
  std::optional<record::OpenedEvent> opened = record::opened_event(event, participant_key);
  if (!opened) throw VerificationError("the event cannot be decrypted");
  return opened->event;
}

inline std::vector<record::Event> as_recorded(const std::vector<record::Event>& events,
                                              const SecretKey& participant_key) {
  std::vector<record::Event> recorded;
  for (const record::Event& event : events) recorded.push_back(as_recorded(event, participant_key));
  return recorded;
}

}  // namespace touchtrial
