#include "bench/machine.hpp"

#include "bench/inputs/simd_name.hpp"
#include "bench/jitter/this_processor.hpp"
#include "tests/engine/simd/targets.hpp"

#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <opencv2/core/version.hpp>

namespace touchtrial::bench {

Machine this_machine() {
  return {fmt::format("{}, {}", this_processor(), instruction_set_of(simd_targets().front())),
          TOUCHTRIAL_COMPILER, CV_VERSION,
          fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))};
}

}  // namespace touchtrial::bench
