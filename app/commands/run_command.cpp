// run: runs one session with one participant.
#include "app/commands/commands.hpp"
#include "app/run/run_session.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "study/station.hpp"

#include <string>

namespace touchtrial::app {
namespace {

OnExisting policy_of(const std::string& text) {
  if (text == "refuse") return OnExisting::refuse;
  if (text == "resume") return OnExisting::resume;
  if (text == "restart") return OnExisting::restart;
  throw CLI::ValidationError("--on-existing",
                             "'" + text + "' is unknown; give refuse, resume or restart");
}

int run(const RunOptions& options) {
  if (options.database.empty()) throw UsageError("run: --db is empty; give it a file name");
  if (options.is_simulated() && !options.device.empty()) {
    throw UsageError("run: --device is for people; omit it with --subject");
  }
  if (!options.hand_device.empty() && !options.is_simulated() && options.device != "simulated") {
    throw UsageError(
        "run: --on is for simulated hands; add --subject or --device simulated, or omit --on");
  }
  if (options.is_simulated() && options.participant.empty()) {
    throw UsageError(
        "run: a simulated participant needs an id; give --participant, for instance S01");
  }
  return run_study_session(options);
}

void add_session_options(CLI::App& command, RunOptions& options) {
  add_study_argument(command, options.study);
  command.add_option("--participant", options.participant,
                     "Id, for instance P07; not a name (default: a window asks for it and the "
                     "consent)");
  command.add_option("--db", options.database, "Database; created if it does not exist")
      ->check(place_validator())
      ->required();
  add_pack_option(command, options.pack);
  auto* file =
      command.add_option("--station-file", options.station_file,
                         "File of this station (default: <study>.station beside the pack)");
  command.add_option_function<std::string>(
      "--heads", [&options](const std::string& folder) { options.heads.folder = folder; },
      "Folder of the second head file, on another disk (default: the previous one)");
  add_accept_loss_option(command, options.heads.accept_loss);
  add_passphrase_option(command);
  command.add_flag("--pilot", options.pilot,
                   "A pilot session, never pooled; needs its own database");
  command
      .add_option_function<std::string>(
          "--on-existing",
          [&options](const std::string& text) { options.on_existing = policy_of(text); },
          "What to do if the participant has a session: refuse, resume or restart")
      ->type_name("refuse|resume|restart");
  command
      .add_option("--enrolment", options.enrolment,
                  "Enrolment number of this station (default: its next)")
      ->check(CLI::Range(1, study::kMaxEnrolments));
  add_count_option(command, "--visit", options.visit,
                   "Number of the participant's visit, in a study with several", 1, 100);
  command
      .add_option("--station", options.station,
                  "Name of this station, whose file is <study>.NAME.station")
      ->excludes(file);
  command.add_option(
      "--accept-clock", options.accept_clock,
      "Continue after a visit whose date is in the future because of a wrong clock; the reason is "
      "recorded");
  add_yes_flag(command, options.yes);
}

void add_device_options(CLI::App& command, RunOptions& options) {
  add_driver_argument(command, "--device", options.device);
  add_settings_option(command, options.settings);
  command.add_option("--certificate", options.certificate,
                     "Certificate of the device's acceptance (default: NAME-certificate.json)");
  command.add_flag(
      "--allow-unverified", options.allow_unverified,
      "Allow a force-feedback device without a valid certificate; all displays and data are marked "
      "UNVERIFIED DEVICE");
  command.add_flag(
      "--allow-late", options.allow_late,
      "Allow a force-feedback device although the system refuses real-time scheduling; "
      "this is recorded");
  command.add_flag("--console", options.console, "Open a window for the experimenter too");
  command
      .add_option("--console-monitor", options.console_monitor,
                  "Monitor of the experimenter's window")
      ->check(CLI::Range(1, 16));
  command.add_flag("!--no-sound", options.sound, "Play no masking noise and no tones");
  add_window_options(command, options.monitor, options.window_px);
  command
      .add_option("--text-scale", options.text_scale,
                  "Text size for this participant, instead of the study's; recorded")
      ->check(finite_range(1.0, study::kMaxTextScale));
  command.add_flag("--high-contrast", options.high_contrast,
                   "Black on white for this participant; recorded");
}

void add_simulation_options(CLI::App& command, RunOptions& options) {
  CLI::Option* const subject = command.add_option(
      "--subject", options.subject,
      "Simulate the participant with this subject model, or the built-in one if empty; without a "
      "window");
  command.add_flag("--headless")
      ->needs(subject)
      ->description("Without a window; implied by a simulated participant");
  add_on_option(command, options.hand_device);
  add_seed_option(command, options.seed, "Seed of the simulated participant");
  command.add_flag("--real-time", options.real_time, "Simulate the participant in real time");
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
  const auto [command, options] =
      add_command(program, action, "run", "Run one session with one participant", run);
  add_session_options(command, options);
  add_device_options(command, options);
  add_simulation_options(command, options);
}

}  // namespace touchtrial::app
