#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/heads.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/prepare.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/simulation/simulation.hpp"
#include "protocols/store/study_store.hpp"

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

struct SimulateArguments {
  fs::path study;
  fs::path database;
  fs::path subject;
  std::string on;
  simulation::SimulationOptions options;
  bool keep_blind = false;
  bool json = false;
};

void refuse_existing(const fs::path& path) {
  if (is_there(path)) {
    throw StoreError(path.string() +
                     ": exists already; give another --db, or move the old file away");
  }
}

std::string summary_of(const SimulateArguments& arguments,
                       const simulation::SimulationReport& report) {
  const fs::path key = key_path_for(arguments.database, {});
  if (arguments.json) {
    const nlohmann::json summary = {{"simulated", true},
                                    {"sessions", report.sessions},
                                    {"presentations", report.presentations},
                                    {"invalid_trials", report.invalid_trials},
                                    {"ticks", report.ticks},
                                    {"blind", arguments.keep_blind},
                                    {"database", arguments.database.string()},
                                    {"key", key.string()}};
    return json_text(summary);
  }
  return fmt::format("SIMULATED: {} sessions, {} presentations, {}\ndatabase {}\nkey      {}\n",
                     report.sessions, report.presentations,
                     arguments.keep_blind ? "still blind" : "closed and unblinded",
                     arguments.database.string(), key.string());
}

/// Simulated studies need no blinding, unless the blind phase itself is rehearsed.
void end_collection(store::StudyStore& store) {
  store.close_study(0ns);
  store.unblind(0ns, "simulated study", false);
}

int simulate(const SimulateArguments& arguments) {
  if (arguments.database.empty()) throw UsageError("simulate: --db is empty; give it a file name");
  refuse_existing(arguments.database);
  const design::Study study = design::load_study(arguments.study);
  const simulation::SubjectModel subject = subject_for(arguments.subject, study, arguments.on);
  const design::StudyKey key = simulated_key(study, arguments.study);
  refuse_other_key(key_path_for(arguments.database, {}), key);
  prepare_simulated_pack(key);
  const engine::Pack pack(key.pack_folder);
  store::StudyStore store = store::StudyStore::create(
      arguments.database, session::commitment_of(key, pack, true, false), 0ns, key.signer());
  design::save_study_key(key_path_for(arguments.database, {}), key);
  const simulation::SimulationReport report = simulation::simulate_study(
      key, pack, subject, arguments.options, store, progress_bar("simulating"));
  if (!arguments.keep_blind) end_collection(store);
  make_head(store, arguments.database, key.signer());
  print(summary_of(arguments, report));
  return 0;
}

}  // namespace

void add_simulate_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<SimulateArguments>();
  simulation::SimulationOptions& options = arguments->options;
  CLI::App* command = program.add_subcommand(
      "simulate", "Run a whole study with simulated participants, in virtual time");
  add_study_argument(*command, arguments->study);
  command->add_option("--db", arguments->database, "Database to make; its key is written to DB.key")
      ->check(place_validator())
      ->required();
  command->add_option("--participants", options.participants, "Number of participants")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--first-participant", options.first_participant,
                   "Number of the first participant, for a station whose database will be merged")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  add_seed_option(*command, options.seed, "Seed of everything random in participants");
  add_subject_option(*command, arguments->subject);
  add_on_option(*command, arguments->on);
  add_jobs_option(*command, options.jobs);
  command->add_flag("--keep-blind", arguments->keep_blind, "Do not close and unblind at the end");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return simulate(*arguments); }; });
}

}  // namespace touchtrial::app
