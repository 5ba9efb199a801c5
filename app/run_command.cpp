#include "app/commands.hpp"
#include "app/run/run_session.hpp"
#include "core/errors.hpp"
#include "protocols/design/enrolment_plan.hpp"

#include <charconv>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace touchtrial::app {
namespace {

/// "1280x720"
std::pair<int, int> size_of(const std::string& text) {
  constexpr int kSmallest = 320;
  constexpr int kLargest = 16384;
  std::pair<int, int> size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.first);
  const bool has_cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height = has_cross ? std::from_chars(width.ptr + 1, end, size.second) : width;
  const bool whole = has_cross && height.ec == std::errc() && height.ptr == end;
  const auto fits = [](int side) { return side >= kSmallest && side <= kLargest; };
  if (!whole || !fits(size.first) || !fits(size.second)) {
    throw CLI::ValidationError(
        "--window", "'" + text + "' is no size; give WIDTHxHEIGHT, for instance 1280x720");
  }
  return size;
}

void check(const RunOptions& options) {
  if (options.database.empty()) throw UsageError("run: --db is empty; give it a file name");
  if (!options.is_simulated() && options.headless) {
    throw UsageError("run: --headless is for simulated participants; give --subject, or leave it");
  }
}

void add_session_options(CLI::App& command, RunOptions& options) {
  const std::map<std::string, OnExisting> policies = {{"refuse", OnExisting::refuse},
                                                      {"resume", OnExisting::resume},
                                                      {"restart", OnExisting::restart}};
  command.add_option("STUDY", options.study, "Study file")->required();
  command.add_option("--participant", options.participant, "Id, for instance P07; no name")
      ->required();
  command.add_option("--db", options.database, "Database; made if it is not there")
      ->check(place_validator())
      ->required();
  command.add_option("--pack", options.pack, "Pack (default: STUDY.pack beside the study file)");
  command.add_option("--key", options.key, "Key (default: that beside the database or the pack)");
  command.add_flag("--pilot", options.pilot, "A trial run, never pooled; has its own database");
  command
      .add_option("--on-existing", options.on_existing,
                  "A session that this participant has already: refuse, resume or restart")
      ->transform(CLI::CheckedTransformer(policies).description("refuse|resume|restart"));
  command
      .add_option("--enrolment", options.enrolment,
                  "Place in the order of participants, which decides the schedule (default: the "
                  "smallest that is free)")
      ->check(CLI::Range(1, design::kMostPlanned));
  command
      .add_option("--station", options.station,
                  "This station's name in the plan: its next enrolment number is taken")
      ->excludes("--enrolment");
  command.add_option("--plan", options.plan,
                     "Enrolment plan (default: <study>.plan.json, if it is there)");
}

void add_device_options(CLI::App& command, RunOptions& options) {
  command.add_option("--device", options.device, "Driver, as touchtrial device list names it");
  add_settings_option(command, options.settings);
  command.add_option("--certificate", options.certificate,
                     "The device's calibration (default: NAME-certificate.json, if it is there)");
  command.add_flag("--console", options.console, "A window for the experimenter too");
  command.add_option("--console-monitor", options.console_monitor, "Its monitor, from 1")
      ->check(CLI::Range(1, 16));
  command.add_flag("!--no-sound", options.sound, "Neither masking noise nor tones");
  command.add_option("--monitor", options.monitor, "The participant's monitor, from 1")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command.add_option_function<std::string>(
      "--window", [&options](const std::string& text) { options.window_px = size_of(text); },
      "WIDTHxHEIGHT: a window instead of the whole monitor, pixels");
}

void add_simulation_options(CLI::App& command, RunOptions& options) {
  command.add_option("--subject", options.subject,
                     "A simulated participant: a subject model, or an empty text for the built-in");
  command.add_option("--seed", options.seed, "Seed of the simulated participant")
      ->check(seed_validator())
      ->capture_default_str();
  command.add_flag("--headless", options.headless, "No window: for simulated participants");
  command.add_flag("--real-time", options.real_time, "A simulated participant in real time");
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand("run", "One session with one participant");
  add_session_options(*command, *options);
  add_device_options(*command, *options);
  add_simulation_options(*command, *options);
  command->callback([=, &action] {
    action = [=] {
      check(*options);
      return run_study_session(*options);
    };
  });
}

}  // namespace touchtrial::app
