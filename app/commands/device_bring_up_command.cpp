// device bring-up: guides a person through half an hour of tests on a device that the project does
// not have, and records them in one file to send in.
#include "app/commands/acceptance_terminal.hpp"
#include "app/commands/commands.hpp"
#include "app/terminal/console.hpp"
#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/version.hpp"
#include "device/acceptance/bring_up/bring_up.hpp"
#include "device/drivers/registry.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

constexpr int kEndedEarly = 1;

struct BringUpArguments {
  std::string program;  ///< as printed by `--version`
  std::string driver;
  fs::path settings;
  fs::path out;
  bool facts = false;
  bool json = false;
};

/// The lab's limits apply, but neither its corrections nor the weight compensation of a Falcon:
/// readings must be uncorrected, and no force may be added to the small test forces.
device::DeviceSettings settings_of(const BringUpArguments& arguments) {
  device::DeviceSettings settings = device::load_device_settings(arguments.settings);
  settings.falcon.gravity_bias_n = {};
  if (const auto use = settings.uses.find(arguments.driver); use != settings.uses.end()) {
    use->second.scale = {};
  }
  return settings;
}

std::string steps_line(const device::BringUp& record) {
  std::vector<std::string> unfinished;
  for (std::size_t i = 0; i < device::kBringUpSteps; ++i) {
    if (record.outcomes.at(i) == device::StepOutcome::done) continue;
    unfinished.push_back(fmt::format("{} ({})", name_of(static_cast<device::BringUpStep>(i)),
                                     name_of(record.outcomes.at(i))));
  }
  return unfinished.empty() ? "" : fmt::format("steps not done: {}\n", fmt::join(unfinished, ", "));
}

int print_facts(const BringUpArguments& arguments) {
  std::string text;
  nlohmann::ordered_json facts = nlohmann::ordered_json::object();
  for (const device::DeviceDriver& driver : device::device_drivers()) {
    if (driver.unverified.empty()) continue;
    if (!arguments.driver.empty() && arguments.driver != driver.name) continue;
    text += driver.name + ":\n";
    for (const device::UnverifiedFact& fact : driver.unverified) {
      text += fmt::format("  {}: {}\n", fact.id, fact.what);
      facts[driver.name][fact.id] = fact.what;
    }
  }
  print(arguments.json ? json_text(facts) : text);
  return 0;
}

int run_bring_up(const BringUpArguments& arguments, const fs::path& out) {
  std::optional<device::BringUp> record;
  const auto save = [&] { replace_file(out, device::bring_up_json(*record)); };
  const auto save_partial = [&](const std::string& reason) {
    if (!record) return;
    record->reason = reason;
    save();
    std::fprintf(stderr, "the results so far are in %s\n", out.string().c_str());
  };
  try {
    const device::DeviceSettings settings = settings_of(arguments);
    AcceptanceTerminal terminal(arguments.driver, settings);
    record = device::bring_up_of(terminal.info());
    record->stand_in = device::stand_in_of(terminal.info(), settings);
    record->program = arguments.program;
    record->scheduling = std::string(device::name_of(terminal.scheduling().policy));
    record->memory_locked = terminal.scheduling().memory_locked;
    save();
    device::bring_up(terminal, terminal, device::device_driver(arguments.driver).unverified,
                     *record, save);
  } catch (const AcceptanceStopped&) {
    save_partial("stopped by a person or a signal");
    if (device::StopOnSignals::stop_requested()) {
      std::fprintf(stderr, "touchtrial: %s\n", device::StopOnSignals::message().c_str());
      return device::StopOnSignals::exit_code();
    }
    throw DeviceError("the bring-up was stopped; run it again, or send the file as it is");
  } catch (const UsageError&) {
    save_partial("the input ended");
    throw;
  }
  print("send this file to the project: " + out.string() + "\n" + steps_line(*record));
  return record->ended == device::BringUpEnd::complete ? 0 : kEndedEarly;
}

int bring_up_device(const BringUpArguments& arguments) {
  if (arguments.facts) return print_facts(arguments);
  if (arguments.driver.empty()) {
    throw UsageError("device bring-up: name a device from `touchtrial device list`");
  }
  const fs::path out =
      arguments.out.empty() ? fs::path(arguments.driver + "-bring-up.json") : arguments.out;
  refuse_link(out);
  if (path_exists(out)) {
    throw FileError(one_line(out.string()) +
                    ": exists already; name another file with --out, or move it away");
  }
  return run_in_child_process([&] { return run_bring_up(arguments, out); });
}

}  // namespace

void add_device_bring_up_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<BringUpArguments>();
  for (const CLI::App* app = &device; app != nullptr; app = app->get_parent()) {
    arguments->program = app->version();
  }
  CLI::App* command = device.add_subcommand(
      "bring-up",
      "Try a device that the project has not tested: half an hour of small forces "
      "and questions, whose results are one anonymous file to send in");
  add_driver_argument(*command, "NAME", arguments->driver);
  add_settings_option(*command, arguments->settings);
  command->add_option("--out", arguments->out, "File to write (default: NAME-bring-up.json)");
  command->add_flag("--facts", arguments->facts,
                    "Print the facts about the devices that are still unverified");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return bring_up_device(*arguments); }; });
}

}  // namespace touchtrial::app
