#include "bench/machine.hpp"

#include "bench/inputs/simd_name.hpp"
#include "engine/simd/targets.hpp"

#include <ctime>
#include <fstream>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <opencv2/core/version.hpp>

namespace touchtrial::bench {
namespace {

/// As Linux calls it; elsewhere only the instruction set is known.
std::string model_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace

Machine this_machine() {
  return {fmt::format("{}, {} logical cores, {}", model_name(), std::thread::hardware_concurrency(),
                      instruction_set_of(simd_targets().front())),
          TOUCHTRIAL_COMPILER, CV_VERSION,
          fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))};
}

}  // namespace touchtrial::bench
