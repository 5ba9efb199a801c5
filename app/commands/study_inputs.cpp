#include "app/commands/study_inputs.hpp"

#include "analysis/outcomes/sealed_sessions.hpp"
#include "analysis/planning/level_report.hpp"
#include "app/commands/pilot_thresholds.hpp"
#include "app/commands/shipped_files.hpp"
#include "app/terminal/console.hpp"
#include "app/texts/study_texts.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/public_keys.hpp"
#include "core/user_folders.hpp"
#include "device/device_settings.hpp"
#include "device/drivers/registry.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "study/key_protection.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {

std::filesystem::path key_path_for(const std::filesystem::path& database,
                                   const std::filesystem::path& explicit_path) {
  if (!explicit_path.empty()) return explicit_path;
  std::filesystem::path key = database;
  key += ".key";
  return key;
}

namespace {

/// The file that stores the path of each database's key; empty without a home folder.
std::filesystem::path remembered_keys_path() {
  const std::filesystem::path settings = device::default_device_settings_path();
  return settings.empty() ? settings : settings.parent_path() / "keys.json";
}

std::string absolute_name(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(file, ignored);
  return canonical.empty() ? file.string() : canonical.string();
}

/// Returns no entries if the file is damaged.
nlohmann::json remembered_keys() {
  constexpr std::uintmax_t kMaxFileBytes = 1U << 20U;
  const std::filesystem::path path = remembered_keys_path();
  if (path.empty() || !path_exists(path)) return nlohmann::json::object();
  nlohmann::json keys =
      nlohmann::json::parse(text_of(read_file(path, kMaxFileBytes)), nullptr, false);
  return keys.is_object() ? keys : nlohmann::json::object();
}

/// Stores the key's path, unless there is no writable home folder, for instance for a service.
void remember_key(const std::filesystem::path& database, const std::filesystem::path& key) {
  const std::filesystem::path path = remembered_keys_path();
  const std::string database_name = absolute_name(database);
  const std::string key_name = absolute_name(key);
  try {
    nlohmann::json keys = remembered_keys();
    if (path.empty() || keys.value(database_name, "") == key_name) return;
    keys[database_name] = key_name;
    std::filesystem::create_directories(path.parent_path());
    replace_file(path, json_text(keys), FileMode::owner_only);
  } catch (const FileError&) {
  } catch (const std::filesystem::filesystem_error&) {
  } catch (const nlohmann::json::exception&) {
  }
}

}  // namespace

std::filesystem::path remembered_key(const std::filesystem::path& database) {
  try {
    const nlohmann::json keys = remembered_keys();
    const auto entry = keys.find(absolute_name(database));
    if (entry == keys.end() || !entry->is_string()) return {};
    return entry->get<std::string>();
  } catch (const FileError&) {
    return {};
  }
}

std::filesystem::path key_in_use(const std::filesystem::path& database,
                                 const std::filesystem::path& explicit_path) {
  std::filesystem::path path = key_path_for(database, explicit_path);
  if (path != key_path_for(database, {}) || path_exists(path)) return path;
  std::filesystem::path remembered_path = remembered_key(database);
  return !remembered_path.empty() && path_exists(remembered_path) ? remembered_path : path;
}

study::StudyKey key_of_database(const record::StudyStore& store,
                                const std::filesystem::path& database,
                                const std::filesystem::path& explicit_path) {
  const std::filesystem::path path = key_in_use(database, explicit_path);
  const bool is_beside = path == key_path_for(database, {});
  if (is_beside && !path_exists(path)) {
    const std::filesystem::path last_key = remembered_key(database);
    throw FileError(
        path.string() + ": there is no key beside the database" +
        (last_key.empty() ? "" : ", and none at " + last_key.string() + ", which was used last") +
        "; name it with --key");
  }
  study::StudyKey key = study::load_study_key(path);
  try {
    analysis::require_key_of(store, key);
  } catch (const VerificationError& mismatch) {
    throw VerificationError(path.string() + ": is not the key of " +
                            one_line(database.filename().string()) + ": " + mismatch.what());
  }
  if (!is_beside) remember_key(database, path);
  key.pack_folder = study::find_pack(key, database);
  return key;
}

analysis::Outcomes outcomes_of(const record::StudyStore& store, const study::StudyKey& key,
                               const std::string& participant) {
  analysis::Outcomes outcomes = analysis::load_outcomes(store, key, participant);
  outcomes.questionnaires = questionnaires_of(outcomes.design);
  return outcomes;
}

std::vector<record::PersonalRecord> consents_beside(const std::filesystem::path& database) {
  const std::filesystem::path path = record::personal_data_path(database);
  if (!path_exists(path)) return {};
  return record::PersonalData(path).all();
}

std::string blind_words(const record::StudyState& state) {
  return state.question ? "blind except for the registered question" : "not unblinded";
}

namespace {

/// Whether the unencrypted part of a protected file names another station than the database's.
bool belongs_to_other_station(const std::filesystem::path& file,
                              const record::StudyCommitment& commitment) {
  const std::optional<PublicKey> signer = study::unencrypted_signer(file);
  return signer && commitment.station && *signer != commitment.station->key;
}

/// The file of the database's station in one of the folders; empty if there is none.
/// \param read_errors  receives the reasons why files could not be read
std::optional<study::StationKey> station_key_in(std::span<const std::filesystem::path> folders,
                                                const record::StudyCommitment& commitment,
                                                std::string& read_errors) {
  if (!commitment.station) return std::nullopt;
  for (const std::filesystem::path& folder : folders) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      if (entry.path().extension() != ".station") continue;
      try {
        if (belongs_to_other_station(entry.path(), commitment)) continue;
        study::StationKey key = study::load_station_key(entry.path());
        if (key.signer().public_half() == commitment.station->key) return key;
      } catch (const UsageError&) {
        throw;  // the passphrase prompt was cancelled
      } catch (const Error& error) {
        read_errors += std::string("; ") + error.what();
      }
    }
  }
  return std::nullopt;
}

/// \throws as sign_with_files
Signer signer_for(const record::StudyStore& store, const std::filesystem::path& database,
                  const SigningFiles& files) {
  if (!files.station.empty()) {
    return station_key_for(store.commitment(), database, files.station).signer();
  }
  if (!files.key.empty() || path_exists(key_path_for(database, {}))) {
    return key_of_database(store, database, files.key).signer();
  }
  std::vector<std::filesystem::path> folders = {"."};
  std::error_code ignored;
  if (database.has_parent_path() &&
      !std::filesystem::equivalent(database.parent_path(), ".", ignored)) {
    folders.insert(folders.begin(), database.parent_path());
  }
  std::string read_errors;
  if (const auto key = station_key_in(folders, store.commitment(), read_errors)) {
    return key->signer();
  }
  if (const std::filesystem::path last_key = remembered_key(database);
      !last_key.empty() && path_exists(last_key)) {
    return key_of_database(store, database, last_key).signer();
  }
  throw StoreError(
      one_line(database.string()) +
      ": records must be signed, and neither the database's folder nor this one "
      "contains its station's file; name it with --station-file, or the investigator's key "
      "with --key" +
      one_line(read_errors));
}

}  // namespace

study::StationKey station_key_for(const record::StudyCommitment& commitment,
                                  const std::filesystem::path& database,
                                  const std::filesystem::path& file) {
  if (belongs_to_other_station(file, commitment)) {
    throw StoreError(one_line(file.string() + ": is not the file of station " +
                              commitment.station->name + ", to which " + database.string() +
                              " belongs; give that station's file with --station-file, or another "
                              "database"));
  }
  return study::load_station_key(file);
}

void sign_with_files(record::StudyStore& store, const std::filesystem::path& database,
                     const SigningFiles& files) {
  const Signer signer = signer_for(store, database, files);
  store.sign_with(signer);
  set_head_writer(store, database, signer, {.accept_loss = files.accept_loss}, HeadUse::if_present);
}

record::StudyStore open_for_recording(const std::filesystem::path& database,
                                      const SigningFiles& files) {
  record::StudyStore store =
      record::StudyStore::open(database, record::StudyStore::Access::read_write);
  sign_with_files(store, database, files);
  return store;
}

void print_head(const record::StudyStore& store, const std::filesystem::path& database) {
  if (!path_exists(record::head_path_for(database))) return;
  print(head_words(store) + "; write it on the day sheet\n");
}

study::PackPlace pack_place_for(const std::filesystem::path& study_file,
                                const std::filesystem::path& pack) {
  return pack.empty() ? study::default_pack_place(study_file) : study::pack_place_at(pack);
}

void save_station_files(const study::StudyKey& key, const study::PackPlace& place) {
  for (const study::Station& station : key.stations) {
    study::save_station_key(place.station(station.name), study::station_key(key, station.name));
  }
}

study::StudyKey simulated_key(const study::Study& study, const std::filesystem::path& study_file) {
  refuse_installed_study(study_file);
  study::StudyKey key = study::simulated_study_key(study);
  key.pack_folder = study::simulated_pack_place(study_file).pack;
  return key;
}

namespace {

/// The gains of a study that states its level.
study::LevelGains level_gains(const study::StudyKey& key) {
  if (!key.study.level) return {};
  const device::DeviceModel device = simulation::device_of(key.study);
  const simulation::LevelCurve curve = curve_of(key.study, device);
  return [=, &key](std::span<const engine::FieldView> fields) {
    simulation::GainsAtLevel result =
        simulation::gains_at_level(key, fields, device, curve, cores());
    return std::pair(std::move(result.gains), std::move(result.remarks));
  };
}

/// Applies the laboratory's pilot thresholds, if the study names a readable database of pilots.
simulation::StimulusLevels with_pilot_thresholds(simulation::StimulusLevels levels,
                                                 const study::Study& study) {
  if (!study.level) return levels;
  try {
    const simulation::LevelCurve curve = curve_of(study, simulation::device_of(study));
    if (curve.pilots_db) simulation::apply(curve, levels);
  } catch (const Error& error) {
    spdlog::warn("levels are computed from published curves: {}", error.what());
  }
  return levels;
}

}  // namespace

int cores() {
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

study::PrepareReport prepare_with_progress(const study::PackLock& lock, const study::StudyKey& key,
                                           study::PrepareOptions options) {
  options.level_gains = level_gains(key);
  return study::prepare_pack(lock, key, progress_bar("preparing"), options);
}

void prepare_simulated_pack(const study::StudyKey& key) {
  static_cast<void>(study::plane_of(key.study));
  using Lock = study::PackLock;
  const Lock lock(key.pack_folder, Lock::Use::prepare, Lock::Wait::yes);
  const study::PrepareReport report = prepare_with_progress(lock, key, {.statistics = false});
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
}

void refuse_other_key(const std::filesystem::path& path, const study::StudyKey& key) {
  if (path_exists(path) && study::load_study_key(path).seal != key.seal) {
    throw StoreError(path.string() +
                     ": exists already; give another --db, or move the old file away");
  }
}

simulation::StimulusLevels levels_of_pack(const study::StudyCodes& key) {
  const engine::Pack pack(key.pack_folder);
  const session::StimulusSource source(pack, key.study.rendering);
  return with_pilot_thresholds(
      simulation::levels_of(key, source, simulation::level_devices(key.study), cores()), key.study);
}

std::unique_ptr<const analysis::Results> with_levels(
    std::unique_ptr<const analysis::Results> results, const study::StudyKey& key) {
  if (!path_exists(key.pack_folder / "pack.json")) return results;
  try {
    simulation::StimulusLevels levels = levels_of_pack(key);
    return planning::with_levels(std::move(results), key.study, std::move(levels));
  } catch (const FileError& error) {
    spdlog::warn("the levels of the stimuli are left out: {}", error.what());
  }
  return results;
}

simulation::SubjectModel subject_for(const std::filesystem::path& path, const study::Study& study,
                                     const std::string& hand_device) {
  simulation::SubjectModel subject =
      path.empty() ? simulation::default_subject() : simulation::load_subject_model(path);
  subject.check_labels(study);
  if (!hand_device.empty()) {
    subject.device = device::model_of_device(hand_device);
  } else if (!study.device.empty()) {
    subject.device = simulation::device_of(study);
  }
  return subject;
}

}  // namespace touchtrial::app
