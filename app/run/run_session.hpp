/// \file One session of a study, from the command line's options to its end.
#pragma once

#include "app/run/run_options.hpp"

namespace touchtrial::app {

/// Runs the session of a person with a device or of a simulated participant, before a window unless
/// it is headless. A window belongs to the calling thread, which must be the program's main thread;
/// the session then runs on another thread.
/// \return the exit code: 0 if the session is complete, 1 if it was stopped or left open, 128 plus
///   the signal's number if a signal ended the program
/// \throws touchtrial::Error with the remedy, before the session is opened or when it cannot go on;
///   an open session stays open and can be resumed
[[nodiscard]] int run_study_session(const RunOptions& options);

}  // namespace touchtrial::app
