// device conform: checks a driver, mainly a laboratory's own plug-in.
#include "analysis/report/text_table.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/device_words.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "device/acceptance/conformance/conformance.hpp"
#include "device/acceptance/conformance/plugin_conformance.hpp"
#include "device/drivers/mouse/mouse_device.hpp"
#include "device/drivers/registry.hpp"
#include "device/platform/stop_signals.hpp"
#include "device/servo/servo_clock.hpp"
#include "device/servo/servo_control.hpp"
#include "device/servo/servo_thread.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

constexpr const char* kPluginDriver = "plugin";
constexpr int kDoesNotConform = 1;

struct ConformArguments {
  std::string target;
  std::filesystem::path settings;
  double seconds = 2.0;
  bool force = false;
  bool yes = false;
  bool json = false;
};

/// Whether the target is a file, not a driver's name.
bool is_library(const std::string& target) {
  return target.find('/') != std::string::npos || target.ends_with(".so");
}

const char* word_for(device::ConformanceOutcome outcome) {
  switch (outcome) {
    case device::ConformanceOutcome::passed:
      return "passed";
    case device::ConformanceOutcome::failed:
      return "FAILED";
    case device::ConformanceOutcome::not_observed:
      break;
  }
  return "not observed";
}

int count_of(const std::vector<device::ConformanceCheck>& checks,
             device::ConformanceOutcome outcome) {
  return static_cast<int>(std::ranges::count(checks, outcome, &device::ConformanceCheck::outcome));
}

/// One line per check; below a failed one, what the driver must do.
std::string conformance_text(const std::string& target,
                             const std::vector<device::ConformanceCheck>& checks) {
  std::string text = target + "\n";
  for (const device::ConformanceCheck& check : checks) {
    text += analysis::wrapped(fmt::format("  {:<14}{:<24}", word_for(check.outcome), check.name),
                              check.finding.empty() ? "-" : one_line(check.finding));
    if (check.outcome == device::ConformanceOutcome::failed) {
      text += analysis::wrapped(std::string(16, ' '), check.meaning);
    }
  }
  using enum device::ConformanceOutcome;
  const char* verdict = device::conforms(checks)       ? "conforms, as far as observed"
                        : count_of(checks, failed) > 0 ? "DOES NOT CONFORM"
                                                       : "NOT CHECKED";
  return text + fmt::format("{}: {} passed, {} failed, {} not observed\n", verdict,
                            count_of(checks, passed), count_of(checks, failed),
                            count_of(checks, not_observed));
}

std::string conformance_json(const std::string& target,
                             const std::vector<device::ConformanceCheck>& checks) {
  using nlohmann::ordered_json;
  ordered_json rows = ordered_json::array();
  for (const device::ConformanceCheck& check : checks) {
    rows.push_back({{"check", check.name},
                    {"outcome", device::name_of(check.outcome)},
                    {"finding", check.finding},
                    {"meaning", check.meaning}});
  }
  return json_text(
      ordered_json{{"target", target}, {"conforms", device::conforms(checks)}, {"checks", rows}});
}

/// Halts a device on signals and crashes.
struct SignalGuard {
  explicit SignalGuard(device::HapticDevice& device) : signals(device, control) {}
  device::ServoControl control;
  device::StopOnSignals signals;
};

device::ConformanceOptions options_of(const ConformArguments& arguments) {
  device::ConformanceOptions options;
  options.seconds = arguments.seconds;
  options.pushes = arguments.force;
  options.stopped = device::StopOnSignals::stop_requested;
  options.guard = [](device::HapticDevice& device) {
    return std::make_shared<SignalGuard>(device);
  };
  options.advise = [](device::DeviceReadiness readiness) {
    const std::string advice = readiness_in_words(readiness);
    if (!advice.empty()) std::fprintf(stderr, "%s\n", advice.c_str());
  };
  return options;
}

/// \throws UsageError if the target cannot be checked in this way
void require_checkable(const ConformArguments& arguments, bool is_plugin) {
  if (arguments.target == device::kMouseDriver) {
    throw UsageError(
        "conform: the mouse needs a window and a hand, and has no motors; try it in a session, "
        "with `touchtrial run STUDY --db pilot.db --device mouse --pilot`");
  }
  if (arguments.force && !is_plugin) {
    throw UsageError("conform: the commands to the motors of '" + one_line(arguments.target) +
                     "' cannot be observed; --force requires a plug-in that exports "
                     "touchtrial_device_observe_v1");
  }
}

/// Runs the checks on a real-time thread, as the servo does.
std::vector<device::ConformanceCheck> run_checks(const ConformArguments& arguments,
                                                 const device::DeviceSettings& settings,
                                                 bool is_plugin, device::SchedulingPolicy policy) {
  const device::ConformanceOptions options = options_of(arguments);
  device::PacedClock clock(device::PacedClock::default_spin(policy));
  if (is_plugin) return device::check_plugin_conformance(settings.plugin, clock, options);
  device::ConformanceSubject subject;
  // Opens the driver itself, without the lab's scales.
  subject.open = [&] { return device::device_driver(arguments.target).open(settings); };
  return device::check_conformance(subject, clock, options);
}

int conform(ConformArguments arguments) {
  device::DeviceSettings settings = device::load_device_settings(arguments.settings);
  const bool is_file = is_library(arguments.target);
  // A name without a slash would be searched for in the system's folders.
  if (is_file) settings.plugin.library = std::filesystem::absolute(arguments.target);
  if (!is_file) arguments.target = device::device_driver(arguments.target).name;
  const bool is_plugin = is_file || arguments.target == kPluginDriver;
  require_checkable(arguments, is_plugin);
  if (arguments.force) {
    confirm(fmt::format("{}: forces of {} N push the handle along each axis; rest it on the table "
                        "or hold it lightly",
                        arguments.target, device::ConformanceOptions::kPushN),
            arguments.yes);
  }
  std::vector<device::ConformanceCheck> checks;
  device::ServoThread thread;
  const device::SchedulingPolicy policy = thread.scheduling().policy;
  thread.run([&] { checks = run_checks(arguments, settings, is_plugin, policy); });
  print(arguments.json ? conformance_json(arguments.target, checks)
                       : conformance_text(arguments.target, checks));
  if (device::StopOnSignals::stop_requested()) {
    std::fprintf(stderr, "touchtrial: %s\n", device::StopOnSignals::message().c_str());
    return device::StopOnSignals::exit_code();
  }
  return device::conforms(checks) ? 0 : kDoesNotConform;
}

}  // namespace

void add_device_conform_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<ConformArguments>();
  CLI::App* command = device.add_subcommand(
      "conform", "Check a driver, such as your own plug-in: readings, zero forces, timing");
  command
      ->add_option("DRIVER", arguments->target,
                   "A plug-in file (FILE.so, or a path), or a device or driver as listed by "
                   "touchtrial device list")
      ->required();
  add_settings_option(*command, arguments->settings);
  command->add_option("--seconds", arguments->seconds, "How long to observe readings, s")
      ->check(finite_range(0.2, 600.0))
      ->capture_default_str();
  command->add_flag("--force", arguments->force,
                    "Also push with 0.3 N along each axis, to check that forces start and stop");
  add_yes_flag(*command, arguments->yes);
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return conform(*arguments); }; });
}

}  // namespace touchtrial::app
