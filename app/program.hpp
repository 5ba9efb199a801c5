/// \file The command line: `touchtrial COMMAND ...`.
#pragma once

namespace touchtrial::app {

/// Parses the arguments, runs one command, and reports any error as one line on standard error.
/// \return 0 done, 1 failed, 2 bad arguments or bad study file, 3 verification failed
int run_program(int argc, char** argv) noexcept;

}  // namespace touchtrial::app
