/// \file What a sealed box is bound to, so that none can be passed off as another. Sessions are
/// named by their own number (Event::own_session). Part of the format: docs/data-dictionary.md,
/// "Events".
#pragma once

#include "protocols/store/event.hpp"

#include <cstdint>
#include <string>

namespace touchtrial::store {

[[nodiscard]] inline std::string event_context(int own_session, std::int64_t sequence,
                                               EventKind kind) {
  return "event|" + std::to_string(own_session) + "|" + std::to_string(sequence) + "|" +
         std::string(name_of(kind));
}

[[nodiscard]] inline std::string trace_context(int own_session, int trial) {
  return "trace|" + std::to_string(own_session) + "|" + std::to_string(trial);
}

[[nodiscard]] inline std::string participant_key_context(int own_session) {
  return "participant-key|" + std::to_string(own_session);
}

}  // namespace touchtrial::store
