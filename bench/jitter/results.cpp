#include "bench/jitter/results.hpp"

#include "device/servo/servo.hpp"

#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
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
          {"written_samples", m.written},
          {"end", device::name_of(m.report.end)}};
}

std::string model_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

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
      lateness ? fmt::format("{:.1f}", m.report.rate_hz) : fmt::format("{}", m.written));
}

}  // namespace

std::string this_processor() {
  return fmt::format("{}, {} logical cores", model_name(), std::thread::hardware_concurrency());
}

std::string results_json(Measured what, std::span<const Measurement> measurements) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Measurement& m : measurements) all.push_back(json_of(m));
  const nlohmann::ordered_json results = {
      {"processor", this_processor()},
      {"measured", what == Measured::lateness ? "lateness" : "service"},
      {"measurements", all}};
  return results.dump(2) + "\n";
}

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
