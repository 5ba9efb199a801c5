/// \file The words for the states of sessions in exports. Private to exports.
#pragma once

#include "protocols/store/study_store.hpp"

namespace touchtrial::analysis {

/// "completed", "stopped" or "open".
[[nodiscard]] const char* text_of(store::SessionState state);

}  // namespace touchtrial::analysis
