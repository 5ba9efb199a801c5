/// \file One session of a study, from the command line's options to its end.
#pragma once

#include "app/run/run_options.hpp"

namespace touchtrial::app {

/// \return the exit code: 0 if the session is complete, 1 if it was stopped or left open, 128 and
///   the signal's number if a signal ended the program
/// \throws touchtrial::Error with the remedy before a session is opened, or when one cannot go on:
///   it then stays open and can be taken up
[[nodiscard]] int run_study_session(const RunOptions& options);

}  // namespace touchtrial::app
