/// \file The command line of servo_jitter, a program of its own.
#pragma once

namespace touchtrial::app::jitter {

/// Parses the arguments, measures, and reports any error as one line on standard error.
/// \return 0 done, 1 failed, 2 bad arguments
int run_program(int argc, char** argv) noexcept;

}  // namespace touchtrial::app::jitter
