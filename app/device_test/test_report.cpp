#include "app/device_test/test_report.hpp"

#include "device/servo/servo_names.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

/// Ticks as time, by the rate that the run was to have.
double seconds_of(std::int64_t ticks, const device::ServoReport& report) {
  return report.rate_hz > 0.0 ? static_cast<double>(ticks) / report.rate_hz : 0.0;
}

std::string phase_text(const TestPhase& phase, const device::ServoReport& run) {
  return fmt::format("{:<8} {:5.1f} s, contact {:5.1f} s, greatest force {:.2f} N\n", phase.name,
                     seconds_of(phase.felt.ticks, run), seconds_of(phase.felt.contact_ticks, run),
                     phase.felt.greatest_force_n);
}

const char* words_for(const device::ServoReport& run, bool quit) {
  if (run.fault == device::SafetyFault::emergency_stop) return "halted";
  switch (run.end) {
    case device::ServoEnd::time_limit:
      return "time was up";
    case device::ServoEnd::hand_stopped:
      return quit ? "stopped by q" : "the device had no more to give";
    case device::ServoEnd::comfort_stop:
      return "let go on request";
    case device::ServoEnd::fault:
      break;
  }
  return "fault";
}

std::string run_text(const device::ServoReport& run, bool quit) {
  const std::string fault =
      run.fault == device::SafetyFault::none ? "" : fmt::format(", {}", device::name_of(run.fault));
  const std::string device = run.device_fault == device::DeviceFault::none
                                 ? ""
                                 : fmt::format(" ({})", device::name_of(run.device_fault));
  return fmt::format(
      "ticks:   {:.1f} a second, {} left out; {} forces changed by safety (limit {:.2f} N)\n"
      "late:    half within {:.0f} us, 99 % {:.0f} us, 99.9 % {:.0f} us, worst {:.0f} us\n"
      "ended:   {}{}{}\n",
      run.rate_hz, run.overruns, run.limited_ticks, run.force_limit_n, run.lateness.p50_us,
      run.lateness.p99_us, run.lateness.p999_us, run.lateness.worst_us, words_for(run, quit), fault,
      device);
}

std::string scheduling_text(const device::SchedulingObtained& had) {
  const std::string got = had.policy == device::SchedulingPolicy::fifo
                              ? fmt::format("real time, priority {}", had.priority)
                              : std::string("as an ordinary thread");
  return "servo:   " + got + (had.memory_locked ? ", memory locked" : ", memory not locked") +
         (had.reason.empty() ? "" : "; " + had.reason) + "\n";
}

nlohmann::ordered_json phase_json(const TestPhase& phase, const device::ServoReport& run) {
  return {{"phase", phase.name},
          {"ticks", phase.felt.ticks},
          {"contact_s", seconds_of(phase.felt.contact_ticks, run)},
          {"greatest_force_n", phase.felt.greatest_force_n}};
}

nlohmann::ordered_json run_json(const device::ServoReport& run) {
  return {{"end", device::name_of(run.end)},
          {"fault", device::name_of(run.fault)},
          {"device_fault", device::name_of(run.device_fault)},
          {"ticks", run.ticks},
          {"rate_hz", run.rate_hz},
          {"overruns", run.overruns},
          {"limited_ticks", run.limited_ticks},
          {"contact_s", seconds_of(run.contact_ticks, run)},
          {"force_limit_n", run.force_limit_n},
          {"lateness_us",
           {{"p50", run.lateness.p50_us},
            {"p99", run.lateness.p99_us},
            {"p999", run.lateness.p999_us},
            {"worst", run.lateness.worst_us}}}};
}

}  // namespace

std::string test_text(const DeviceTest& test) {
  const device::DeviceInfo& device = test.device;
  std::string text = device.name + (device.model.empty() ? "" : ": " + device.model) +
                     (device.serial.empty() ? "" : ", serial " + device.serial) +
                     (device.firmware.empty() ? "" : ", firmware " + device.firmware) + "\n" +
                     scheduling_text(test.scheduling);
  if (!test.run) return text + "ended:   stopped before the test began\n";
  for (const TestPhase& phase : test.phases) text += phase_text(phase, *test.run);
  text += run_text(*test.run, test.quit);
  if (!test.fault_record.empty()) {
    text += "flight record of the fault: " + test.fault_record.string() + "\n";
  }
  return text;
}

std::string test_json(const DeviceTest& test) {
  using nlohmann::ordered_json;
  ordered_json phases = ordered_json::array();
  for (const TestPhase& phase : test.phases) phases.push_back(phase_json(phase, *test.run));
  const ordered_json object = {{"driver", test.device.name},
                               {"model", test.device.model},
                               {"serial", test.device.serial},
                               {"firmware", test.device.firmware},
                               {"scheduling",
                                {{"policy", device::name_of(test.scheduling.policy)},
                                 {"priority", test.scheduling.priority},
                                 {"memory_locked", test.scheduling.memory_locked},
                                 {"reason", test.scheduling.reason}}},
                               {"run", test.run ? run_json(*test.run) : ordered_json(nullptr)},
                               {"phases", phases},
                               {"fault_record", test.fault_record.string()}};
  return object.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace touchtrial::app
