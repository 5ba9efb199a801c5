/// \file The benchmark's command line.
#pragma once

namespace touchtrial::bench {

/// \return 0 done (whether goals are met or not), 1 failed, 2 bad arguments
int run_program(int argc, char** argv);

}  // namespace touchtrial::bench
