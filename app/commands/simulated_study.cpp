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
  if (path_exists(path)) {
    throw StoreError(path.string() +
                     ": exists already; give another --db, or move the old file away");
  }
}

/// Moves a head file into place, over the head file of a database that no longer exists.
void write_head_beside(const std::filesystem::path& draft_head,
                       const std::filesystem::path& place) {
  refuse_link(place);
  std::error_code error;
  std::filesystem::rename(draft_head, place, error);
  if (error) {
    throw StoreError(one_line(place.string()) + ": cannot be written (" + error.message() +
                     "); check the folder and its permissions");
  }
}

/// Closes and unblinds: a simulated study needs no blinding, unless the blind phase is rehearsed.
void end_collection(record::StudyStore& store) {
  store.close_study(0ns);
  store.unblind(0ns, "simulated study", false);
}

}  // namespace

simulation::SimulationReport simulate_study(const StudyToSimulate& request) {
  refuse_link(request.database);
  refuse_existing(request.database);
  const study::Study study = study::load_study(request.study);
  const simulation::SubjectModel subject = subject_for(request.subject, study, request.hand_device);
  const study::StudyKey key = simulated_key(study, request.study);
  const std::filesystem::path key_file = key_path_for(request.database, {});
  refuse_other_key(key_file, key);
  prepare_simulated_pack(key);
  const engine::Pack pack(key.pack_folder);
  const Draft draft(request.database, Draft::Kind::folder);
  const std::filesystem::path draft_database = draft.path() / request.database.filename();
  std::optional<record::StudyStore> store = record::StudyStore::create(
      draft_database, session::commitment_of(key, pack, true, false), 0ns, key.signer());
  const simulation::SimulationReport report = simulation::simulate_study(
      key, pack, subject, request.options, *store, progress_bar("simulating"));
  if (!request.keep_blind) end_collection(*store);
  make_head(*store, draft_database, key.signer());
  store.reset();  // closes it, so that no journal remains
  study::save_study_key(key_file, key);
  // Last, so that an existing database is complete.
  write_head_beside(record::head_path_for(draft_database), record::head_path_for(request.database));
  if (!move_to_free_name(draft_database, request.database)) refuse_existing(request.database);
  return report;
}

std::string simulation_json(const StudyToSimulate& request,
                            const simulation::SimulationReport& report) {
  return json_text(nlohmann::json{{"simulated", true},
                                  {"simulated_on", analysis::device_words({report.device})},
                                  {"sessions", report.sessions},
                                  {"presentations", report.presentations},
                                  {"invalid_trials", report.invalid_trials},
                                  {"ticks", report.ticks},
                                  {"blind", request.keep_blind},
                                  {"database", request.database.string()},
                                  {"key", key_path_for(request.database, {}).string()}});
}

}  // namespace touchtrial::app
