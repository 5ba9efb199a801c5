// device test: shows live readings of a device while a person feels a plain wall, then a texture;
// or without force.
#include "app/commands/commands.hpp"
#include "app/commands/device_words.hpp"
#include "app/commands/test_texture.hpp"
#include "app/run/attended_run.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/outputs.hpp"
#include "device/drivers/registry.hpp"
#include "device/haptic_device.hpp"
#include "device/model/workspace_fit.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/force_sequence.hpp"
#include "device/servo/servo.hpp"
#include "protocols/session/exploration.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct TestPhase {
  std::string name;  ///< "watch", "wall" or "texture"
  device::ForceSequence::Part totals;
};

struct DeviceTest {
  device::DeviceInfo device;
  device::SchedulingObtained scheduling;
  std::optional<device::ServoReport> run;  ///< empty if stopped before the start
  bool quit = false;                       ///< the person pressed q
  std::vector<TestPhase> phases;           ///< only those that started
  fs::path fault_record;                   ///< empty unless a fault was recorded
};

/// Converts ticks to time at the nominal rate.
double seconds_of(std::int64_t ticks, const device::ServoReport& report) {
  return report.rate_hz > 0.0 ? static_cast<double>(ticks) / report.rate_hz : 0.0;
}

std::string phase_text(const TestPhase& phase, const device::ServoReport& run) {
  return fmt::format("{:<8} {:5.1f} s, contact {:5.1f} s, maximum force {:.2f} N\n", phase.name,
                     seconds_of(phase.totals.ticks, run),
                     seconds_of(phase.totals.contact_ticks, run), phase.totals.max_force_n);
}

const char* words_for(const device::ServoReport& run, bool quit) {
  if (run.fault == device::SafetyFault::emergency_stop) return "halted";
  switch (run.end) {
    case device::ServoEnd::time_limit:
      return "time was up";
    case device::ServoEnd::hand_stopped:
      return quit ? "stopped by q" : "end of the device's recording";
    case device::ServoEnd::comfort_stop:
      return "force released on request";
    case device::ServoEnd::fault:
      break;
  }
  return "fault";
}

std::string run_text(const device::ServoReport& run, bool quit) {
  const bool is_fault = run.fault != device::SafetyFault::none;
  return fmt::format(
      "ticks:   {:.1f} per second, {} skipped; {} forces changed by safety (limit {:.2f} N)\n"
      "late:    half within {:.0f} us, 99 % {:.0f} us, 99.9 % {:.0f} us, worst {:.0f} us\n"
      "ended:   {}{}\n",
      run.rate_hz, run.overruns, run.limited_ticks, run.force_limit_n, run.lateness.p50_us,
      run.lateness.p99_us, run.lateness.p999_us, run.lateness.worst_us, words_for(run, quit),
      is_fault ? ", " + fault_names(run) : "");
}

/// Empty unless the device reports it.
std::string delivered_text(const device::ServoReport& run) {
  if (run.delivered_share == 0.0) return "";
  return fmt::format("device:  reports {:.0f} % of the commanded force\n",
                     100.0 * run.delivered_share);
}

std::string scheduling_text(const device::SchedulingObtained& scheduling) {
  const std::string words = scheduling.policy == device::SchedulingPolicy::fifo
                                ? fmt::format("real time, priority {}", scheduling.priority)
                                : std::string("as an ordinary thread");
  return "servo:   " + words +
         (scheduling.memory_locked ? ", memory locked" : ", memory not locked") +
         (scheduling.reason.empty() ? "" : "; " + scheduling.reason) + "\n";
}

nlohmann::ordered_json phase_json(const TestPhase& phase, const device::ServoReport& run) {
  return {{"phase", phase.name},
          {"ticks", phase.totals.ticks},
          {"contact_s", seconds_of(phase.totals.contact_ticks, run)},
          {"greatest_force_n", phase.totals.max_force_n}};
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
          {"delivered_share", run.delivered_share},
          {"lateness_us",
           {{"p50", run.lateness.p50_us},
            {"p99", run.lateness.p99_us},
            {"p999", run.lateness.p999_us},
            {"worst", run.lateness.worst_us}}}};
}

std::string test_text(const DeviceTest& test) {
  const device::DeviceInfo& device = test.device;
  std::string text = device.name + (device.model.empty() ? "" : ": " + device.model) +
                     (device.serial.empty() ? "" : ", serial " + device.serial) +
                     (device.firmware.empty() ? "" : ", firmware " + device.firmware) + "\n" +
                     scheduling_text(test.scheduling);
  if (!test.run) return text + "ended:   stopped before the test began\n";
  for (const TestPhase& phase : test.phases) text += phase_text(phase, *test.run);
  text += delivered_text(*test.run) + run_text(*test.run, test.quit);
  if (!test.fault_record.empty()) {
    text += "flight record of the fault: " + test.fault_record.string() + "\n";
  }
  return text;
}

/// The format is documented in docs/devices/README.md.
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
  return json_text(object);
}

/// The duration of the transition from wall to texture.
constexpr double kBlendS = 0.2;
/// 40 mm, which fits the workspace of every supported device.
constexpr int kPlacedSidePx = 200;
/// 100 mm, for devices whose plane may have any size.
constexpr int kFreeSidePx = 500;
constexpr double kTestS = 30.0;
/// Practically unlimited.
constexpr double kWatchS = 7.0 * 86'400.0;

struct TestArguments {
  std::string driver;
  fs::path settings;
  double seconds = 0.0;  ///< 0: kTestS or kWatchS
  double rate_hz = device::kServoRateHz;
  bool watch = false;
  bool wall_only = false;
  bool json = false;
  fs::path fault_record;
};

/// The device for the servo, with the plane placed in its frame unless only readings are requested.
class DeviceForTest {
 public:
  DeviceForTest(const TestArguments& arguments, const device::DeviceSettings& settings)
      : use_(settings.use_of(arguments.driver)),
        device_(device::open_device(arguments.driver, settings)) {
    if (arguments.watch) return;
    const device::DeviceInfo info = device_->info();
    texture_.emplace(info.workspace ? kPlacedSidePx : kFreeSidePx, info.max_stiffness_n_per_mm);
    const device::WorkspaceFit fit = device::fit_plane(texture_->plane(), info.workspace, use_);
    if (fit.placement) placed_device_.emplace(*device_, *fit.placement);
  }

  [[nodiscard]] device::HapticDevice& device() noexcept {
    return placed_device_ ? static_cast<device::HapticDevice&>(*placed_device_) : *device_;
  }
  [[nodiscard]] const TestTexture& texture() const { return texture_.value(); }
  [[nodiscard]] device::SafetyLimits limits() const noexcept {
    return device::stricter_of({}, use_.limits);
  }

 private:
  device::DeviceUse use_;
  std::unique_ptr<device::HapticDevice> device_;
  std::optional<TestTexture> texture_;
  std::optional<device::PlacedDevice> placed_device_;
};

fs::path record_path(const TestArguments& arguments) {
  return arguments.fault_record.empty() ? fs::path("device-test-" + arguments.driver + "-fault.csv")
                                        : arguments.fault_record;
}

constexpr const char* kKeys =
    "q ends, space releases the force, Ctrl-C halts at once\n"
    "shown: time, position ({}), force, ticks per second, lateness\n";

/// One run without force, in the device's own frame, even if the device is not ready.
void watch(const TestArguments& arguments, device::HapticDevice& device, AttendedRun& run,
           DeviceTest& test) {
  const std::string advice = readiness_in_words(device.readiness());
  if (!advice.empty()) std::fprintf(stderr, "%s: %s\n", arguments.driver.c_str(), advice.c_str());
  std::fputs(fmt::format(kKeys, "right, up, towards you").c_str(), stderr);
  NoForce no_force;
  device::ForceSequence sequence(no_force, no_force, std::numeric_limits<std::int64_t>::max(), 1);
  const double seconds = arguments.seconds > 0.0 ? arguments.seconds : kWatchS;
  test.run = run.run([](std::int64_t) { return "watch"; }, sequence, sequence, seconds);
  if (test.run) test.phases.push_back({"watch", sequence.first()});
}

/// One run: the wall, then the texture unless only the wall is requested.
void feel(const TestArguments& arguments, const TestTexture& test_texture, AttendedRun& run,
          DeviceTest& test) {
  const engine::RenderingModel wall = test_texture.wall();
  const engine::RenderingModel texture = test_texture.texture();
  session::ModelForce wall_force(wall);
  session::ModelForce texture_force(texture);
  const double seconds = arguments.seconds > 0.0 ? arguments.seconds : kTestS;
  const double change_s = seconds * (arguments.wall_only ? 2.0 : 0.5);
  device::ForceSequence sequence(wall_force, texture_force,
                                 std::llround(change_s * arguments.rate_hz),
                                 std::llround(kBlendS * arguments.rate_hz));
  const auto phase = [&](std::int64_t tick) {
    return sequence.is_second(tick) ? "texture" : "wall";
  };
  std::fputs(
      (fmt::format(kKeys, "right, down, off the plane") + "- and + change the strength\n").c_str(),
      stderr);
  test.run = run.run(phase, sequence, sequence, seconds);
  if (!test.run) return;
  test.phases.push_back({"wall", sequence.first()});
  if (sequence.second().ticks > 0) test.phases.push_back({"texture", sequence.second()});
}

/// \return the exit code
/// \throws DeviceError if the run ended with a fault
int exit_code_of(const DeviceTest& test, const AttendedRun& run) {
  if (run.stop() == AttendedStop::signal) {
    std::fprintf(stderr, "touchtrial: %s\n", device::StopOnSignals::message().c_str());
    return device::StopOnSignals::exit_code();
  }
  if (!test.run || test.run->end != device::ServoEnd::fault) return 0;
  throw DeviceError(one_line(test.device.name + ": fault in the phase '" + test.phases.back().name +
                             "': " + fault_names(*test.run) + ": " + fault_in_words(*test.run) +
                             "; the last seconds are in " + test.fault_record.string()));
}

int test_device(const TestArguments& arguments) {
  require_output_path(record_path(arguments));
  const device::DeviceSettings settings = device::load_device_settings(arguments.settings);
  DeviceForTest device_for_test(arguments, settings);
  AttendedRun run(device_for_test.device(), device_for_test.limits(), arguments.rate_hz);
  DeviceTest test;
  if (arguments.watch) {
    test.device = device_for_test.device().info();
    watch(arguments, device_for_test.device(), run, test);
  } else {
    run.wait_until_ready(kReadyLimitS);
    run.enable_strength_keys();
    test.device = device_for_test.device().info();
    feel(arguments, device_for_test.texture(), run, test);
  }
  test.scheduling = run.scheduling();
  test.quit = run.stop() == AttendedStop::quit;
  if (test.run && test.run->end == device::ServoEnd::fault && run.stop() != AttendedStop::signal) {
    test.fault_record = record_path(arguments);
    write_output(test.fault_record, run.flight_record());
  }
  print(arguments.json ? test_json(test) : test_text(test));
  return exit_code_of(test, run);
}

}  // namespace

void add_device_test_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<TestArguments>();
  CLI::App* command = device.add_subcommand(
      "test",
      "Show a device's live readings while you feel a plain wall and a texture, or, with --watch, "
      "without force");
  add_driver_argument(*command, "NAME", arguments->driver)->required();
  add_settings_option(*command, arguments->settings);
  command
      ->add_option("--seconds", arguments->seconds,
                   "Duration, s (default: 30 for wall and texture together; --watch: until q)")
      ->check(finite_range(0.1, 3600.0));
  CLI::Option* watch = command->add_flag("--watch", arguments->watch,
                                         "Show readings only, in the device's own frame");
  add_rate_option(*command, arguments->rate_hz);
  command->add_flag("--wall-only", arguments->wall_only, "Skip the texture")->excludes(watch);
  add_force_flag(*command);
  add_json_flag(*command, arguments->json);
  command->add_option("--fault-record", arguments->fault_record,
                      "CSV file for the last seconds before a fault (default: "
                      "device-test-NAME-fault.csv)");
  command->callback([=, &action] { action = [=] { return test_device(*arguments); }; });
}

}  // namespace touchtrial::app
