#include "bench/jitter/results.hpp"
#include "bench/jitter/this_processor.hpp"
#include "device/servo/servo_names.hpp"

#include <set>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::bench::jitter {
namespace {

constexpr const char* kLatenessHead =
    "| rate, Hz | asked | had | load | p50, us | p99, us | p99.9, us | worst, us | left out | "
    "rate had, Hz |\n| ---: | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
constexpr const char* kServiceHead =
    "| ticks | asked | had | load | p50, us | p99, us | p99.9, us | worst, us | dropped | "
    "written |\n| ---: | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";

std::string scheduling_of(const device::SchedulingObtained& had) {
  std::string text(device::name_of(had.policy));
  if (had.policy == device::SchedulingPolicy::fifo) text += fmt::format(" {}", had.priority);
  return text + (had.memory_locked ? ", locked" : "");
}

std::string row_of(Measured what, const Measurement& m) {
  const bool lateness = what == Measured::lateness;
  const auto us = [&](double share) {
    const double value = m.histogram.percentile_us(share);
    return value < 10.0 ? fmt::format("{:.2f}", value) : fmt::format("{:.0f}", value);
  };
  return fmt::format(
      "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
      lateness ? fmt::format("{:.0f}", m.conditions.rate_hz) : fmt::format("{}", m.report.ticks),
      device::name_of(m.conditions.policy), scheduling_of(m.scheduling), m.conditions.load, us(0.5),
      us(0.99), us(0.999), us(1.0), lateness ? m.report.overruns : m.dropped,
      lateness ? fmt::format("{:.1f}", m.report.rate_hz) : fmt::format("{}", m.written.samples));
}

}  // namespace

std::string results_text(Measured what, std::span<const Measurement> measurements) {
  std::string text =
      this_processor() + "\n\n" + (what == Measured::lateness ? kLatenessHead : kServiceHead);
  std::set<std::string> reasons;
  for (const Measurement& m : measurements) {
    text += row_of(what, m);
    if (!m.scheduling.reason.empty()) reasons.insert(m.scheduling.reason);
    if (m.report.end == device::ServoEnd::fault) {
      reasons.insert("a run ended early with the fault " +
                     std::string(device::name_of(m.report.fault)));
    }
    if (what == Measured::lateness && m.dropped > 0) {
      reasons.insert(fmt::format("{} samples were lost: the writer did not keep up", m.dropped));
    }
  }
  for (const std::string& reason : reasons) text += "\n" + reason + "\n";
  return text;
}

}  // namespace touchtrial::bench::jitter
