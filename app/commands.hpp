/// \file The commands. Each adds itself to the parser and sets the action that runs when parsing
/// succeeds. Commands parse, call the rooms below, and print; they compute nothing themselves.
/// Private to app: it shows the parser's type.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

/// The work of the chosen command.
/// \return the exit code
/// \throws touchtrial::Error
using Action = std::function<int()>;

/// The exit code of data that fail verification.
inline constexpr int kNotVerified = 3;

void add_extract_command(CLI::App& program, Action& action);
void add_evaluate_command(CLI::App& program, Action& action);
void add_stimuli_command(CLI::App& program, Action& action);
/// The commands of "stimuli".
void add_stimuli_sheet_command(CLI::App& stimuli, Action& action);
void add_stimuli_measure_command(CLI::App& stimuli, Action& action);
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
/// consent, exclude, replace, withdraw, note, close, unblind, migrate.
void add_record_commands(CLI::App& program, Action& action);
void add_merge_command(CLI::App& program, Action& action);
void add_power_command(CLI::App& program, Action& action);
void add_device_command(CLI::App& program, Action& action);
/// The commands of "device".
void add_device_test_command(CLI::App& device, Action& action);
void add_device_fit_command(CLI::App& device, Action& action);
void add_device_calibrate_command(CLI::App& device, Action& action);
void add_device_monitor_command(CLI::App& device, Action& action);

}  // namespace touchtrial::app
