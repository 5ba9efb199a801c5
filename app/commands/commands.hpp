/// \file The commands, and the arguments and options that several of them share. Each command adds
///   itself to the parser and sets the action that runs when parsing succeeds. Commands parse, call
///   other libraries, and print; they compute nothing themselves. Private to app: it exposes the
///   parser's type.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

struct SigningFiles;

/// Runs the chosen command.
/// \return the exit code
/// \throws touchtrial::Error
using Action = std::function<int()>;

/// The exit code if data fail verification.
inline constexpr int kNotVerified = 3;

/// A command and its arguments, which exist as long as the command.
template <typename Arguments>
struct Command {
  CLI::App& command;
  Arguments& arguments;
};

/// Adds a subcommand, whose work starts when parsing succeeds.
template <typename Arguments>
Command<Arguments> add_command(CLI::App& parent, Action& action, const std::string& name,
                               const std::string& meaning, int (*work)(const Arguments&)) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = parent.add_subcommand(name, meaning);
  command->callback([=, &action] { action = [=] { return work(*arguments); }; });
  return {*command, *arguments};
}

/// Adds all commands.
void add_commands(CLI::App& program, Action& action);
/// Runs one command from within another.
/// \param words  the command line without the program's name
/// \return the exit code
/// \throws CLI::ParseError, and the command's exceptions
int run_command(const std::vector<std::string>& words);

void add_extract_command(CLI::App& program, Action& action);
void add_evaluate_command(CLI::App& program, Action& action);
void add_paper_command(CLI::App& program, Action& action);
void add_stimuli_command(CLI::App& program, Action& action);
/// The commands of "stimuli".
void add_stimuli_sheet_command(CLI::App& stimuli, Action& action);
void add_stimuli_measure_command(CLI::App& stimuli, Action& action);
void add_new_command(CLI::App& program, Action& action);
/// examples, demo.
void add_examples_commands(CLI::App& program, Action& action);
void add_preview_command(CLI::App& program, Action& action);
void add_prepare_command(CLI::App& program, Action& action);
void add_prereg_command(CLI::App& program, Action& action);
void add_simulate_command(CLI::App& program, Action& action);
void add_plan_command(CLI::App& program, Action& action);
void add_run_command(CLI::App& program, Action& action);
void add_sync_command(CLI::App& program, Action& action);
void add_verify_command(CLI::App& program, Action& action);
void add_report_command(CLI::App& program, Action& action);
void add_export_command(CLI::App& program, Action& action);
void add_fit_command(CLI::App& program, Action& action);
void add_consent_command(CLI::App& program, Action& action);
void add_status_command(CLI::App& program, Action& action);
void add_key_command(CLI::App& program, Action& action);
/// The command "key check".
void add_key_check_command(CLI::App& keys, Action& action);
/// exclude, replace, withdraw, note.
void add_people_commands(CLI::App& program, Action& action);
/// close, unblind.
void add_study_end_commands(CLI::App& program, Action& action);
void add_merge_command(CLI::App& program, Action& action);
void add_power_command(CLI::App& program, Action& action);
void add_procedure_command(CLI::App& program, Action& action);
void add_device_command(CLI::App& program, Action& action);
void add_screen_command(CLI::App& program, Action& action);
/// reference, a hidden command.
void add_reference_command(CLI::App& program, Action& action);
/// The commands of "device".
void add_device_test_command(CLI::App& device, Action& action);
void add_device_fit_command(CLI::App& device, Action& action);
void add_device_accept_command(CLI::App& device, Action& action);
void add_device_bring_up_command(CLI::App& device, Action& action);
void add_device_conform_command(CLI::App& device, Action& action);

/// \name Files
/// Every variable must live as long as the command.
///@{

/// The protocols whose studies `new` and `stimuli import` can write: those without their own
/// section in the study file. The others start from an example study (touchtrial examples).
[[nodiscard]] std::vector<std::string> protocols_of_new_studies();
/// STUDY, required.
void add_study_argument(CLI::App& command, std::filesystem::path& study);
/// DB, required: a database file, not an address.
CLI::Option* add_database_argument(CLI::App& command, std::filesystem::path& database,
                                   const std::string& meaning = "Database of the study");
/// --key, see key_of_database; and --passphrase-file, see app/terminal/passphrases.hpp.
CLI::Option* add_key_option(CLI::App& command, std::filesystem::path& key,
                            const std::string& meaning =
                                "Key of the study (default: DB.key, or the "
                                "one used last)");
/// --passphrase-file, for commands that read keys or stations' files without --key.
void add_passphrase_option(CLI::App& command);
/// --accept-loss: the reason for continuing despite a loss that the head file reveals.
CLI::Option* add_accept_loss_option(CLI::App& command, std::string& reason);
/// --key, --station-file and --accept-loss, for commands that record; see open_for_recording.
void add_signing_options(CLI::App& command, SigningFiles& files);
/// --pack; see pack_place_for.
void add_pack_option(CLI::App& command, std::filesystem::path& pack);
/// --subject; see subject_for.
void add_subject_option(CLI::App& command, std::filesystem::path& subject);
/// --on: the device that simulated hands hold; see subject_for.
void add_on_option(CLI::App& command, std::string& model);
/// Refuses addresses where a local file or folder is needed. The message does not repeat the
/// address, which may contain a password.
[[nodiscard]] CLI::Validator place_validator();

///@}
/// \name Devices
///@{

/// A driver, by its own name or a product's; sets `driver` to the driver's name. The UsageError for
/// an unknown name suggests the nearest.
/// \param name  name of the argument or option
CLI::Option* add_driver_argument(CLI::App& command, const std::string& name, std::string& driver);
/// --settings; see device::load_device_settings.
void add_settings_option(CLI::App& command, std::filesystem::path& settings);
/// --monitor, and --window for a window of this size instead of the whole monitor.
/// \param size_meaning  help text of --window
void add_window_options(CLI::App& command, int& monitor,
                        std::optional<std::pair<int, int>>& size_px,
                        const std::string& size_meaning =
                            "Size WIDTHxHEIGHT of a window instead of the whole monitor, pixels");
/// A number from `low` to `high`. The parser's own range accepts "nan".
[[nodiscard]] CLI::Validator finite_range(double low, double high);
/// --rate, 1,000 to 10,000 Hz.
void add_rate_option(CLI::App& command, double& rate_hz);

///@}
/// \name Work and output
///@{

/// --seed: a whole number from 0 to 2^64 - 1. The parser itself would accept -1 for 2^64 - 1.
void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& meaning);
/// A whole number from `min` to `max`, whose default the help shows.
CLI::Option* add_count_option(CLI::App& command, const std::string& name, int& count,
                              const std::string& meaning, int min, int max);
/// --jobs; default: the number of logical cores.
void add_jobs_option(CLI::App& command, int& jobs);
/// --yes: skips confirmation; see confirm of app/terminal/console.hpp.
void add_yes_flag(CLI::App& command, bool& yes);
/// --force, for every command with output paths: see core/outputs.hpp.
CLI::Option* add_force_flag(CLI::App& command);
/// --json
CLI::Option* add_json_flag(CLI::App& command, bool& json);

///@}

}  // namespace touchtrial::app
