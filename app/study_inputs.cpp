#include "app/study_inputs.hpp"

#include "analysis/sealed_sessions.hpp"
#include "app/console.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/collect/collect.hpp"
#include "protocols/collect/server_address.hpp"

#include <spdlog/spdlog.h>

namespace touchtrial::app {

std::filesystem::path key_path_for(const std::filesystem::path& database,
                                   const std::filesystem::path& given) {
  if (!given.empty()) return given;
  std::filesystem::path beside = database;
  beside += ".key";
  return beside;
}

design::StudyKey key_of_database(const store::StudyStore& store,
                                 const std::filesystem::path& database,
                                 const std::filesystem::path& given) {
  if (given.empty() && collect::is_address(database.string())) {
    throw FileError("a study on a server has no key beside it; name the study's key with --key");
  }
  const std::filesystem::path path = key_path_for(database, given);
  if (given.empty() && !is_there(path)) {
    throw FileError(path.string() + ": there is no key beside the database; name it with --key");
  }
  design::StudyKey key = design::load_study_key(path);
  try {
    analysis::require_key_of(store, key);
  } catch (const VerificationError& wrong) {
    throw VerificationError(path.string() + ": is not the key of " +
                            one_line(collect::study_name(database.string())) + ": " + wrong.what());
  }
  return key;
}

design::PackPlace pack_place_for(const std::filesystem::path& study_file,
                                 const std::filesystem::path& pack) {
  return pack.empty() ? design::default_pack_place(study_file) : design::pack_place_at(pack);
}

void save_station_files(const design::StudyKey& key, const design::PackPlace& place) {
  for (const design::Station& station : key.stations) {
    design::save_station_key(place.station(station.name), design::station_key(key, station.name));
  }
}

design::StudyKey simulated_key(const design::Study& study,
                               const std::filesystem::path& study_file) {
  design::StudyKey key = design::simulated_study_key(study);
  key.pack_folder = design::simulated_pack_place(study_file).pack;
  return key;
}

void prepare_simulated_pack(const design::StudyKey& key, bool wait) {
  const design::PrepareReport prepared = design::prepare_pack(
      key, key.pack_folder, progress_bar("preparing"), {.statistics = false, .wait = wait});
  for (const std::string& warning : prepared.warnings) spdlog::warn("{}", warning);
}

void refuse_other_key(const std::filesystem::path& path, const design::StudyKey& key) {
  if (is_there(path) && design::load_study_key(path).seal != key.seal) {
    throw StoreError(path.string() +
                     ": exists already; give another --db, or move the old file away");
  }
}

simulation::SubjectModel subject_for(const std::filesystem::path& path,
                                     const design::Study& study) {
  simulation::SubjectModel subject =
      path.empty()
          ? simulation::parse_subject_model(default_subject_json(), "the default subject model")
          : simulation::load_subject_model(path);
  subject.check_labels(study);
  return subject;
}

}  // namespace touchtrial::app
