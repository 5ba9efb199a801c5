#include "bench/measure/cpu_clock.hpp"

#include <ctime>

namespace touchtrial::bench {

double cpu_clock_us() noexcept {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

}  // namespace touchtrial::bench
