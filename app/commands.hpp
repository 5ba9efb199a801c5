/// \file Every command adds itself to the parser; its action runs after parsing succeeded.
/// Commands parse, call one layer below, and print; they compute nothing themselves.
/// Private to app: it shows the parser's type.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

/// What the chosen command does; returns the exit code. Throws touchtrial::Error.
using Action = std::function<int()>;

/// The exit code where data are not what they should be.
inline constexpr int kNotVerified = 3;

/// A whole number from 0 to 2^64 - 1 and nothing else; the parser itself would take -1 for 2^64
/// - 1.
[[nodiscard]] CLI::Validator seed_validator();

/// A file or folder of this machine: an address is none, and is not repeated, as there may be a
/// password in it.
[[nodiscard]] CLI::Validator place_validator();
/// A database, or the address of one, as postgresql://HOST/NAME; not libpq's own notation, which
/// may hold a password.
[[nodiscard]] CLI::Validator study_place_validator();

void add_extract_command(CLI::App& program, Action& action);
void add_evaluate_command(CLI::App& program, Action& action);
void add_stimuli_command(CLI::App& program, Action& action);
/// These add themselves to the command "stimuli".
void add_stimuli_import_command(CLI::App& stimuli, Action& action);
void add_stimuli_sheet_command(CLI::App& stimuli, Action& action);
void add_stimuli_measure_command(CLI::App& stimuli, Action& action);
void add_prepare_command(CLI::App& program, Action& action);
void add_prereg_command(CLI::App& program, Action& action);
void add_simulate_command(CLI::App& program, Action& action);
void add_plan_command(CLI::App& program, Action& action);
void add_run_command(CLI::App& program, Action& action);
void add_consent_command(CLI::App& program, Action& action);
void add_close_command(CLI::App& program, Action& action);
void add_unblind_command(CLI::App& program, Action& action);
void add_sync_command(CLI::App& program, Action& action);
void add_verify_command(CLI::App& program, Action& action);
void add_report_command(CLI::App& program, Action& action);
void add_export_command(CLI::App& program, Action& action);
void add_fit_command(CLI::App& program, Action& action);
/// exclude, replace, withdraw, note, migrate.
void add_people_commands(CLI::App& program, Action& action);
void add_merge_command(CLI::App& program, Action& action);
void add_power_command(CLI::App& program, Action& action);
void add_device_command(CLI::App& program, Action& action);
/// These add themselves to the command "device".
void add_device_list_command(CLI::App& device, Action& action);
void add_device_test_command(CLI::App& device, Action& action);
void add_device_fit_command(CLI::App& device, Action& action);
void add_device_calibrate_command(CLI::App& device, Action& action);
void add_device_monitor_command(CLI::App& device, Action& action);

/// The option --settings of commands that open devices; see device_settings_for.
void add_settings_option(CLI::App& command, std::filesystem::path& settings);

}  // namespace touchtrial::app
