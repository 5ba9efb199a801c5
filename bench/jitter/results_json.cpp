#include "bench/jitter/results.hpp"
#include "bench/jitter/this_processor.hpp"
#include "device/servo/servo_names.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::bench::jitter {
namespace {

nlohmann::ordered_json json_of(const Measurement& m) {
  return {{"rate_hz", m.conditions.rate_hz},
          {"policy", device::name_of(m.conditions.policy)},
          {"load", m.conditions.load},
          {"obtained",
           {{"policy", device::name_of(m.scheduling.policy)},
            {"priority", m.scheduling.priority},
            {"memory_locked", m.scheduling.memory_locked},
            {"reason", m.scheduling.reason}}},
          {"ticks", m.report.ticks},
          {"overruns", m.report.overruns},
          {"rate_had_hz", m.report.rate_hz},
          {"p50_us", m.histogram.percentile_us(0.5)},
          {"p99_us", m.histogram.percentile_us(0.99)},
          {"p999_us", m.histogram.percentile_us(0.999)},
          {"worst_us", m.histogram.percentile_us(1.0)},
          {"dropped", m.dropped},
          {"written_samples", m.written.samples},
          {"end", device::name_of(m.report.end)}};
}

}  // namespace

std::string results_json(Measured what, std::span<const Measurement> measurements) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Measurement& m : measurements) all.push_back(json_of(m));
  const nlohmann::ordered_json results = {
      {"processor", this_processor()},
      {"measured", what == Measured::lateness ? "lateness" : "service"},
      {"measurements", all}};
  return results.dump(2) + "\n";
}

}  // namespace touchtrial::bench::jitter
