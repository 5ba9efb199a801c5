/// \file A session before a window: of a person with a device, or of a simulated participant.
#pragma once

#include "app/run/run_options.hpp"
#include "app/run/run_study.hpp"

namespace touchtrial::app {

/// The participant's window belongs to the calling thread, the program's main one; the session runs
/// on another. \return as run_study_session
/// \throws as run_study_session, and DeviceError if no window can be had
[[nodiscard]] int run_attended(const RunOptions& options, const RunStudy& study);

/// The same for a simulated participant, who answers with the window's keys.
[[nodiscard]] int run_simulated_at_window(const RunOptions& options, const RunStudy& study);

}  // namespace touchtrial::app
