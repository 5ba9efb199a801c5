// device bring-up: records half an hour with a device that the project does not have, in one file
// to send in.
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

/// The lab's limits apply, but not its corrections and the weight compensation of a Falcon:
/// readings must be the driver's own, and no force may be added to the small ones.
device::DeviceSettings settings_of(const BringUpArguments& arguments) {
  device::DeviceSettings settings = device::device_settings_for(arguments.settings);
  settings.falcon.gravity_bias_n = {};
  if (const auto use = settings.uses.find(arguments.driver); use != settings.uses.end()) {
    use->second.scale = {};
  }
  return settings;
}

std::string steps_line(const device::BringUp& record) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < device::kBringUpSteps; ++i) {
    if (record.outcomes.at(i) == device::StepOutcome::done) continue;
    open.push_back(fmt::format("{} ({})", name_of(static_cast<device::BringUpStep>(i)),
                               name_of(record.outcomes.at(i))));
  }
  return open.empty() ? "" : fmt::format("steps not done: {}\n", fmt::join(open, ", "));
}

int print_facts(const BringUpArguments& arguments) {
  std::string text;
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const device::DeviceDriver& driver : device::device_drivers()) {
    if (driver.unverified.empty()) continue;
    if (!arguments.driver.empty() && arguments.driver != driver.name) continue;
    text += driver.name + ":\n";
    for (const device::UnverifiedFact& fact : driver.unverified) {
      text += fmt::format("  {}: {}\n", fact.id, fact.what);
      all[driver.name][fact.id] = fact.what;
    }
  }
  print(arguments.json ? json_text(all) : text);
  return 0;
}

int lead(const BringUpArguments& arguments, const fs::path& out) {
  std::optional<device::BringUp> record;
  const auto save = [&] { replace_file(out, device::bring_up_json(*record)); };
  const auto keep = [&](const std::string& why) {
    if (!record) return;
    record->why = why;
    save();
    std::fprintf(stderr, "what there is so far: %s\n", out.string().c_str());
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
    keep("stopped by a person or a signal");
    if (device::StopOnSignals::asked()) {
      std::fprintf(stderr, "touchtrial: %s\n", device::StopOnSignals::message().c_str());
      return device::StopOnSignals::exit_code();
    }
    throw DeviceError("the bring-up was stopped; run it again, or send the file as it is");
  } catch (const UsageError&) {
    keep("the input ended");
    throw;
  }
  print("send this file to the project: " + out.string() + "\n" + steps_line(*record));
  return record->ended == device::BringUpEnd::complete ? 0 : kEndedEarly;
}

int bring_up_device(const BringUpArguments& arguments) {
  if (arguments.facts) return print_facts(arguments);
  if (arguments.driver.empty()) {
    throw UsageError("device bring-up: name a device, as touchtrial device list does");
  }
  const fs::path out =
      arguments.out.empty() ? fs::path(arguments.driver + "-bring-up.json") : arguments.out;
  refuse_link(out);
  if (is_there(out)) {
    throw FileError(one_line(out.string()) +
                    ": is there already; name another file with --out, or move it away");
  }
  return in_own_process([&] { return lead(arguments, out); });
}

}  // namespace

void add_device_bring_up_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<BringUpArguments>();
  for (const CLI::App* app = &device; app != nullptr; app = app->get_parent()) {
    arguments->program = app->version();
  }
  CLI::App* command =
      device.add_subcommand("bring-up",
                            "Try a device that is new to the project: half an hour of small forces "
                            "and questions, and one anonymous file to send in");
  add_driver_argument(*command, "NAME", arguments->driver);
  add_settings_option(*command, arguments->settings);
  command->add_option("--out", arguments->out, "File to write (default: NAME-bring-up.json)");
  command->add_flag("--facts", arguments->facts, "Print what is still unverified for the devices");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return bring_up_device(*arguments); }; });
}

}  // namespace touchtrial::app
