#include "app/commands/simulated_study.hpp"

#include "analysis/report/text_figures.hpp"
#include "app/commands/heads.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/commitment.hpp"
#include "record/head_file.hpp"
#include "record/study_store.hpp"

#include <chrono>
#include <optional>
#include <system_error>

#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

using namespace std::chrono_literals;

void refuse_existing(const std::filesystem::path& path) {
  if (is_there(path)) {
    throw StoreError(path.string() +
                     ": exists already; give another --db, or move the old file away");
  }
}

/// Writes a head file over the one of a database that no longer exists.
void write_head_beside(const std::filesystem::path& made, const std::filesystem::path& place) {
  refuse_link(place);
  std::error_code error;
  std::filesystem::rename(made, place, error);
  if (error) {
    throw StoreError(one_line(place.string()) + ": cannot be written (" + error.message() +
                     "); check the folder and its permissions");
  }
}

/// Simulated studies need no blinding, unless the blind phase itself is rehearsed.
void end_collection(record::StudyStore& store) {
  store.close_study(0ns);
  store.unblind(0ns, "simulated study", false);
}

}  // namespace

simulation::SimulationReport simulate_study(const StudyToSimulate& wanted) {
  refuse_link(wanted.database);
  refuse_existing(wanted.database);
  const study::Study study = study::load_study(wanted.study);
  const simulation::SubjectModel subject = subject_for(wanted.subject, study, wanted.on);
  const study::StudyKey key = simulated_key(study, wanted.study);
  const std::filesystem::path key_file = key_path_for(wanted.database, {});
  refuse_other_key(key_file, key);
  prepare_simulated_pack(key);
  const engine::Pack pack(key.pack_folder);
  const Draft draft(wanted.database, Draft::Kind::folder);
  const std::filesystem::path made = draft.path() / wanted.database.filename();
  std::optional<record::StudyStore> store = record::StudyStore::create(
      made, session::commitment_of(key, pack, true, false), 0ns, key.signer());
  const simulation::SimulationReport report = simulation::simulate_study(
      key, pack, subject, wanted.options, *store, progress_bar("simulating"));
  if (!wanted.keep_blind) end_collection(*store);
  make_head(*store, made, key.signer());
  store.reset();  // closes it, so that no journal is left beside it
  study::save_study_key(key_file, key);
  // Last, so that an existing database is complete.
  write_head_beside(record::head_path_for(made), record::head_path_for(wanted.database));
  if (!move_to_free_name(made, wanted.database)) refuse_existing(wanted.database);
  return report;
}

std::string simulation_json(const StudyToSimulate& wanted,
                            const simulation::SimulationReport& report) {
  return json_text(nlohmann::json{{"simulated", true},
                                  {"simulated_on", analysis::device_words({report.device})},
                                  {"sessions", report.sessions},
                                  {"presentations", report.presentations},
                                  {"invalid_trials", report.invalid_trials},
                                  {"ticks", report.ticks},
                                  {"blind", wanted.keep_blind},
                                  {"database", wanted.database.string()},
                                  {"key", key_path_for(wanted.database, {}).string()}});
}

}  // namespace touchtrial::app
