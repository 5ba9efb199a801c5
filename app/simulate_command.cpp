#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/simulated_study.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/prepare.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/simulation.hpp"
#include "protocols/store/study_store.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

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
  session::SimulationOptions options;
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
                       const session::SimulationReport& report) {
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
    return summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }
  return fmt::format("SIMULATED: {} sessions, {} presentations, {}\ndatabase {}\nkey      {}\n",
                     report.sessions, report.presentations,
                     arguments.keep_blind ? "still blind" : "closed and unblinded",
                     arguments.database.string(), key.string());
}

/// Nobody waits blind for a simulated study's end, unless that is what is being rehearsed.
void end_collection(store::StudyStore& store) {
  store.close_study(0ns);
  store.unblind(0ns, "simulated study", false);
}

int simulate(const SimulateArguments& arguments) {
  if (arguments.database.empty()) throw UsageError("simulate: --db is empty; give it a file name");
  refuse_existing(arguments.database);
  const design::Study study = design::load_study(arguments.study);
  const session::SubjectModel subject = subject_for(arguments.subject, study);
  const design::StudyKey key = simulated_key(study, arguments.study);
  refuse_other_key(key_path_for(arguments.database, {}), key);
  prepare_simulated_pack(key);
  const engine::Pack pack(key.pack_folder);
  store::StudyStore store = store::StudyStore::create(
      arguments.database, session::commitment_of(key, pack, true, false), 0ns);
  design::save_study_key(key_path_for(arguments.database, {}), key);
  const session::SimulationReport report = session::simulate_study(
      key, pack, subject, arguments.options, store, progress_bar("simulating"));
  if (!arguments.keep_blind) end_collection(store);
  print(summary_of(arguments, report));
  return 0;
}

}  // namespace

void add_simulate_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<SimulateArguments>();
  arguments->options.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  session::SimulationOptions& options = arguments->options;
  CLI::App* command = program.add_subcommand(
      "simulate", "Run a whole study with simulated participants, in virtual time");
  command->add_option("STUDY", arguments->study, "Study file")->required();
  command->add_option("--db", arguments->database, "Database to make; the key is laid at DB.key")
      ->check(place_validator())
      ->required();
  command->add_option("--participants", options.participants, "How many")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--first-participant", options.first_participant,
                   "Number of the first, for a station that is to be merged with others")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--seed", options.seed, "Seed of everything random in participants")
      ->check(seed_validator())
      ->capture_default_str();
  command->add_option("--subject", arguments->subject, "Subject model (default: built in)");
  command->add_option("--jobs", options.jobs, "Threads; results do not depend on them")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_flag("--keep-blind", arguments->keep_blind, "Do not close and unblind at the end");
  command->add_flag("--json", arguments->json, "Summary as one JSON object");
  command->callback([=, &action] { action = [=] { return simulate(*arguments); }; });
}

}  // namespace touchtrial::app
