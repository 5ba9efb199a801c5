#include "app/device_test/test_report.hpp"

#include "device/servo/servo_names.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

/// Ticks as time, by the rate that the run was to have.
double seconds_of(std::int64_t ticks, const ServoReport& report) {
  return report.rate_hz > 0.0 ? static_cast<double>(ticks) / report.rate_hz : 0.0;
}

std::string phase_text(const TestPhase& phase) {
  const ServoReport& r = phase.report;
  return fmt::format(
      "{}: {:.1f} s at {:.1f} ticks/s, contact {:.1f} s, limit {:.2f} N met in {} ticks\n"
      "  late: half within {:.0f} us, 99 % within {:.0f} us, 99.9 % within {:.0f} us, worst {:.0f} "
      "us; {} ticks left out\n"
      "  ended: {}; fault: {}{}\n",
      phase.name, seconds_of(r.ticks, r), r.rate_hz, seconds_of(r.contact_ticks, r),
      r.force_limit_n, r.limited_ticks, r.lateness.p50_us, r.lateness.p99_us, r.lateness.p999_us,
      r.lateness.worst_us, r.overruns, name_of(r.end), name_of(r.fault),
      r.device_fault == DeviceFault::none ? "" : fmt::format(" ({})", name_of(r.device_fault)));
}

std::string scheduling_text(const SchedulingObtained& had) {
  const std::string got = had.policy == SchedulingPolicy::fifo
                              ? fmt::format("real time, priority {}", had.priority)
                              : std::string("as an ordinary thread");
  return "servo: " + got + (had.memory_locked ? ", memory locked" : ", memory not locked") +
         (had.reason.empty() ? "" : "; " + had.reason) + "\n";
}

nlohmann::ordered_json phase_json(const TestPhase& phase) {
  const ServoReport& r = phase.report;
  return {{"phase", phase.name},
          {"end", name_of(r.end)},
          {"fault", name_of(r.fault)},
          {"device_fault", name_of(r.device_fault)},
          {"ticks", r.ticks},
          {"rate_hz", r.rate_hz},
          {"overruns", r.overruns},
          {"limited_ticks", r.limited_ticks},
          {"contact_s", seconds_of(r.contact_ticks, r)},
          {"force_limit_n", r.force_limit_n},
          {"lateness_us",
           {{"p50", r.lateness.p50_us},
            {"p99", r.lateness.p99_us},
            {"p999", r.lateness.p999_us},
            {"worst", r.lateness.worst_us}}}};
}

}  // namespace

std::string test_text(const DeviceTest& test) {
  const DeviceInfo& device = test.device;
  std::string text = device.name + (device.model.empty() ? "" : ": " + device.model) +
                     (device.serial.empty() ? "" : ", serial " + device.serial) +
                     (device.firmware.empty() ? "" : ", firmware " + device.firmware) + "\n" +
                     scheduling_text(test.scheduling);
  for (const TestPhase& phase : test.phases) text += phase_text(phase);
  if (!test.fault_record.empty()) {
    text += "flight record of the fault: " + test.fault_record.string() + "\n";
  }
  return text;
}

std::string test_json(const DeviceTest& test) {
  using nlohmann::ordered_json;
  ordered_json phases = ordered_json::array();
  for (const TestPhase& phase : test.phases) phases.push_back(phase_json(phase));
  const ordered_json object = {{"driver", test.device.name},
                               {"model", test.device.model},
                               {"serial", test.device.serial},
                               {"firmware", test.device.firmware},
                               {"scheduling",
                                {{"policy", name_of(test.scheduling.policy)},
                                 {"priority", test.scheduling.priority},
                                 {"memory_locked", test.scheduling.memory_locked},
                                 {"reason", test.scheduling.reason}}},
                               {"phases", phases},
                               {"fault_record", test.fault_record.string()}};
  return object.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace touchtrial
