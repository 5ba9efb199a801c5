// simulate: runs a whole study with simulated participants.
#include "analysis/report/text_figures.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/simulated_study.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"

#include <string>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

struct SimulateArguments {
  StudyToSimulate study;
  bool json = false;
};

std::string summary_of(const SimulateArguments& arguments,
                       const simulation::SimulationReport& report) {
  const StudyToSimulate& study = arguments.study;
  if (arguments.json) return simulation_json(study, report);
  return analysis::simulated_on_line(analysis::device_words({report.device})) +
         fmt::format("SIMULATED: {} sessions, {} presentations, {}\ndatabase {}\nkey      {}\n",
                     report.sessions, report.presentations,
                     study.keep_blind ? "still blind" : "closed and unblinded",
                     study.database.string(), key_path_for(study.database, {}).string());
}

int simulate(const SimulateArguments& arguments) {
  if (arguments.study.database.empty())
    throw UsageError("simulate: --db is empty; give it a file name");
  print(summary_of(arguments, simulate_study(arguments.study)));
  return 0;
}

}  // namespace

void add_simulate_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "simulate",
                  "Run a whole study with simulated participants, in virtual time", simulate);
  simulation::SimulationOptions& options = arguments.study.options;
  add_study_argument(command, arguments.study.study);
  command
      .add_option("--db", arguments.study.database,
                  "Database to create; its key is written to DB.key")
      ->check(place_validator())
      ->required();
  add_count_option(command, "--participants", options.participants, "Number of participants", 1,
                   100000);
  add_count_option(command, "--first-participant", options.first_participant,
                   "Number of the first participant, for a station whose database will be merged",
                   1, 1'000'000);
  add_seed_option(command, options.seed, "Seed of the participants' random numbers");
  add_subject_option(command, arguments.study.subject);
  add_on_option(command, arguments.study.hand_device);
  add_jobs_option(command, options.jobs);
  command.add_flag("--keep-blind", arguments.study.keep_blind,
                   "Do not close and unblind at the end");
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
