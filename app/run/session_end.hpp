/// \file How a session ended: in words, and as the program's exit code.
#pragma once

#include "app/run/run_options.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/store/study_store.hpp"

namespace touchtrial::app {

/// Prints the session's summary, which says nothing of outcomes, and, if it was left open, how to
/// take it up again. \return as run_study_session
[[nodiscard]] int conclude_session(const RunOptions& options, int session,
                                   const session::SessionTally& tally,
                                   const store::StudyStore& store);

}  // namespace touchtrial::app
