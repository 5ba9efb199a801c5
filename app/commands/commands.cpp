#include "app/commands/commands.hpp"

#include "app/commands/study_inputs.hpp"
#include "app/reference/pages.hpp"
#include "app/terminal/console.hpp"
#include "app/terminal/passphrases.hpp"
#include "core/outputs.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "device/drivers/registry.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

/// The parser's name for the default group of commands.
constexpr const char* kDefaultGroup = "Subcommands";

/// \param forbidden  text that a value must not contain
CLI::Validator without_text(const std::string& forbidden, const std::string& message) {
  return {[=](const std::string& text) {
            return text.find(forbidden) == std::string::npos ? std::string() : message;
          },
          ""};
}

/// Parses WIDTHxHEIGHT, for instance 1280x720; each side from 320 to 16,384 pixels.
std::pair<int, int> parse_window_size(const std::string& text) {
  const auto side = [](std::string_view part) {
    const auto number = number_in<int>(part);
    return number && *number >= 320 && *number <= 16'384 ? *number : 0;
  };
  const std::string_view view = text;
  const std::size_t cross = view.find('x');
  const bool has_cross = cross != std::string_view::npos;
  const std::pair size{side(view.substr(0, cross)), has_cross ? side(view.substr(cross + 1)) : 0};
  if (size.first == 0 || size.second == 0) {
    throw CLI::ValidationError(
        "--window", "'" + text + "' is not a size; give WIDTHxHEIGHT, for instance 1280x720");
  }
  return size;
}

struct CommandGroup {
  const char* name;
  std::vector<void (*)(CLI::App&, Action&)> add;
};

/// The groups of the help, in order.
const std::vector<CommandGroup>& command_groups() {
  static const std::vector<CommandGroup> groups = {
      {"Design a study",
       {add_new_command, add_examples_commands, add_stimuli_command, add_extract_command,
        add_evaluate_command, add_paper_command, add_procedure_command, add_preview_command,
        add_prepare_command, add_simulate_command, add_power_command, add_prereg_command,
        add_plan_command}},
      {"Run sessions",
       {add_run_command, add_status_command, add_consent_command, add_people_commands,
        add_screen_command}},
      {"Analyse results",
       {add_study_end_commands, add_report_command, add_export_command, add_fit_command}},
      {"Maintain devices, keys and data",
       {add_device_command, add_key_command, add_verify_command, add_sync_command,
        add_merge_command, add_reference_command}}};
  return groups;
}

}  // namespace

void add_commands(CLI::App& program, Action& action) {
  program.formatter(std::make_shared<PageFormatter>());
  program.footer(
      "Start here:\n"
      "  touchtrial demo          both experiments with simulated people\n"
      "  touchtrial new           a study of your own\n"
      "  touchtrial help COMMAND  more about a command");
  for (const CommandGroup& group : command_groups()) {
    for (const auto& add : group.add) add(program, action);
    for (CLI::App* command : program.get_subcommands(
             [](const CLI::App* subcommand) { return subcommand->get_group() == kDefaultGroup; })) {
      command->group(group.name);
    }
  }
}

int run_command(const std::vector<std::string>& words) {
  CLI::App program("", "touchtrial");
  Action action;
  add_commands(program, action);
  program.parse(
      std::vector<std::string>(words.rbegin(), words.rend()));  // the parser expects reverse order
  return action();
}

std::vector<std::string> protocols_of_new_studies() {
  std::vector<std::string> names;
  for (const study::Protocol* protocol : study::protocols()) {
    if (protocol->section.empty()) names.emplace_back(protocol->name);
  }
  return names;
}

void add_study_argument(CLI::App& command, std::filesystem::path& study) {
  command.add_option("STUDY", study, "Study file")->required();
}

CLI::Option* add_database_argument(CLI::App& command, std::filesystem::path& database,
                                   const std::string& meaning) {
  return command.add_option("DB", database, meaning)->required()->check(place_validator());
}

CLI::Option* add_accept_loss_option(CLI::App& command, std::string& reason) {
  return command.add_option("--accept-loss", reason,
                            "Continue although the database has lost data; the reason is recorded");
}

CLI::Option* add_key_option(CLI::App& command, std::filesystem::path& key,
                            const std::string& meaning) {
  add_passphrase_option(command);
  return command.add_option("--key", key, meaning);
}

void add_passphrase_option(CLI::App& command) {
  command
      .add_option(
          "--passphrase-file", passphrase_files(),
          "File or descriptor (/dev/fd/3) whose first line is the passphrase of a protected "
          "key or station's file; may be repeated (default: prompt)")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

void add_signing_options(CLI::App& command, SigningFiles& files) {
  CLI::Option* key =
      add_key_option(command, files.key, "The investigator's key, in place of a station's file");
  command
      .add_option("--station-file", files.station,
                  "This station's file (default: the one beside the database, or here)")
      ->excludes(key);
  add_accept_loss_option(command, files.accept_loss);
}

void add_pack_option(CLI::App& command, std::filesystem::path& pack) {
  command.add_option("--pack", pack, "Folder of the pack (default: <study>.pack)");
}

void add_subject_option(CLI::App& command, std::filesystem::path& subject) {
  command.add_option("--subject", subject, "Subject model (default: built in)");
}

void add_on_option(CLI::App& command, std::string& model) {
  command.add_option("--on", model,
                     "Device that simulated hands hold: a name from touchtrial device models, a "
                     "product, or a model file (default: the study's, or an ideal device)");
}

CLI::Validator place_validator() {
  return without_text(
      "://",
      "is an address, not a file; copy its data to a file with `touchtrial merge ADDRESS "
      "-o all.db`");
}

CLI::Option* add_driver_argument(CLI::App& command, const std::string& name, std::string& driver) {
  const auto to_driver = [](std::string& text) {
    text = device::device_driver(text).name;
    return std::string();
  };
  return command.add_option(name, driver, "Device or driver, as listed by touchtrial device list")
      ->transform(CLI::Validator(
          to_driver, fmt::format("{{{}}}", fmt::join(device::device_names(), ",")), ""));
}

void add_settings_option(CLI::App& command, std::filesystem::path& settings) {
  command.add_option("--settings", settings,
                     "Device settings (default: touchtrial/devices.json in the user's "
                     "configuration folder, if it exists)");
}

void add_window_options(CLI::App& command, int& monitor,
                        std::optional<std::pair<int, int>>& size_px,
                        const std::string& size_meaning) {
  add_count_option(command, "--monitor", monitor, "Monitor of the participant's window", 1, 16);
  command.add_option_function<std::string>(
      "--window", [&size_px](const std::string& text) { size_px = parse_window_size(text); },
      size_meaning);
}

CLI::Validator finite_range(double low, double high) {
  return {[=](const std::string& text) {
            const auto number = number_in<double>(text);
            return number && *number >= low && *number <= high
                       ? std::string()
                       : fmt::format("{} is not a number from {:g} to {:g}", in_quotes(text), low,
                                     high);
          },
          fmt::format("FLOAT in [{:g} - {:g}]", low, high)};
}

void add_rate_option(CLI::App& command, double& rate_hz) {
  command.add_option("--rate", rate_hz, "Servo ticks per second")
      ->check(finite_range(1000.0, 10'000.0))
      ->capture_default_str();
}

void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& meaning) {
  const CLI::Validator whole_number(
      [](const std::string& text) {
        return number_in<std::uint64_t>(text)
                   ? std::string()
                   : text + " is not a whole number from 0 to 18446744073709551615";
      },
      "UINT64");
  command.add_option("--seed", seed, meaning)->check(whole_number)->capture_default_str();
}

CLI::Option* add_count_option(CLI::App& command, const std::string& name, int& count,
                              const std::string& meaning, int min, int max) {
  return command.add_option(name, count, meaning)
      ->check(CLI::Range(min, max))
      ->capture_default_str();
}

void add_jobs_option(CLI::App& command, int& jobs) {
  jobs = cores();
  add_count_option(command, "--jobs", jobs, "Threads; results do not depend on their number", 1,
                   1024);
}

void add_yes_flag(CLI::App& command, bool& yes) {
  command.add_flag("--yes", yes, "Do not ask for confirmation; needed without a terminal");
}

CLI::Option* add_force_flag(CLI::App& command) {
  const auto notice = [](const std::filesystem::path& file, const std::filesystem::path& renamed) {
    spdlog::warn("{}: was renamed to {}", file.string(), renamed.string());
  };
  return command.add_flag_callback(
      "--force", [=] { move_foreign_files_aside(notice); },
      "Replace files that this program did not write or that have changed since; the old files "
      "are renamed to NAME.1, NAME.2 and so on");
}

CLI::Option* add_json_flag(CLI::App& command, bool& json) {
  return command.add_flag("--json", json, "Print one JSON object instead of text");
}

}  // namespace touchtrial::app
