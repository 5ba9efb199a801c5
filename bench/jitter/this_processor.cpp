#include "bench/jitter/this_processor.hpp"

#include <fstream>
#include <thread>

#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

std::string model_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace

std::string this_processor() {
  return fmt::format("{}, {} logical cores", model_name(), std::thread::hardware_concurrency());
}

}  // namespace touchtrial::bench
