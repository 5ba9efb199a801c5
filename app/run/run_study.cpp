#include "app/run/run_study.hpp"

#include "app/console.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/key_protection.hpp"
#include "protocols/session/commitment.hpp"

#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

std::filesystem::path station_file_of(const RunOptions& options, const design::PackPlace& place) {
  return options.station_file.empty() ? place.station(options.station) : options.station_file;
}

/// A protected file of another station than the database's is refused before its passphrase is
/// asked for.
design::StationKey station_key_at(const RunOptions& options, const fs::path& file) {
  if (!design::is_protected(file) || !is_there(options.database)) {
    return design::load_station_key(file);
  }
  const store::StudyStore store =
      store::StudyStore::open(options.database, store::StudyStore::Access::read_only);
  return station_key_for(store.commitment(), options.database, file);
}

void require_unchanged(const design::StationKey& key, const design::Study& study) {
  if (design::are_same(key.study, study)) return;
  throw StudyError(study.source +
                   ": has changed since it was prepared; run `touchtrial prepare` again for a new "
                   "study, or take the change back");
}

/// The investigator's key opens everything that a station should not know.
bool has_key_in_reach(const RunOptions& options, const design::PackPlace& place) {
  if (options.is_simulated() || !is_there(place.key)) return false;
  spdlog::warn(
      "{}: the investigator's key lies at this station, which is recorded as a deviation; move it "
      "to another medium",
      place.key.string());
  return true;
}

void require_intact(const engine::Pack& pack, const design::StudyCodes& key) {
  const std::string folder = pack.folder().string();
  if (pack.manifest().study_id != key.study_id) {
    throw FileError(folder +
                    ": is another study's pack; name it and the station's file with --pack and "
                    "--station-file");
  }
  for (const engine::PackEntry& entry : pack.manifest().entries) {
    if (!pack.is_intact(entry.code)) {
      throw FileError(folder + ": field " + entry.code +
                      " is not what was prepared; copy the pack anew, or run `touchtrial prepare`");
    }
  }
}

RunStudy simulated_study(const RunOptions& options, const design::Study& study) {
  design::StudyKey key = simulated_key(study, options.study);
  const fs::path path = key_path_for(options.database, {});
  refuse_other_key(path, key);
  prepare_simulated_pack(key);
  // Before there is a database, because a database without its key is useless. A database that
  // already exists is another key's.
  if (!is_there(path) && !is_there(options.database)) design::save_study_key(path, key);
  engine::Pack pack(key.pack_folder);
  return {design::station_key(key, design::kOnlyStation), std::move(pack), false};
}

[[noreturn]] void refuse(const RunOptions& options, const std::string& why) {
  throw StoreError(options.database.string() + ": " + why);
}

void require_same(const store::StudyCommitment& stored, const store::StudyCommitment& ours,
                  const RunOptions& options) {
  if (stored.study_id != ours.study_id || stored.seal != ours.seal) {
    refuse(options,
           "is the database of another study, or of this one before it was prepared anew; "
           "give another --db");
  }
  if (stored.station && stored.station != ours.station) {
    refuse(options, "is the database of station " + one_line(stored.station->name) +
                        "; give another --db, or that station's file with --station-file");
  }
  if (stored.pack != ours.pack) {
    refuse(options, "was begun with another pack; name that pack with --pack");
  }
  if (stored.pilot != ours.pilot) {
    refuse(options, stored.pilot ? "is the database of a pilot; give --pilot, or another --db"
                                 : "is not a pilot's database; give pilot sessions another --db");
  }
  if (stored.simulated != ours.simulated) {
    refuse(options, stored.simulated
                        ? "holds simulated participants; give people another --db"
                        : "holds people's sessions; give simulated participants another --db");
  }
}

}  // namespace

RunStudy run_study_for(const RunOptions& options) {
  const design::Study study = design::load_study(options.study);
  const design::PackPlace place = pack_place_for(options.study, options.pack);
  const fs::path file = station_file_of(options, place);
  if (!is_there(file)) {
    if (options.is_simulated() && options.pack.empty() && !is_there(place.pack)) {
      return simulated_study(options, study);
    }
    throw UsageError(
        one_line(file.string()) +
        ": there is no such station file; name this station with --station, or copy its "
        "file here from the investigator's machine, where `touchtrial prepare` writes "
        "it again");
  }
  design::StationKey key = station_key_at(options, file);
  require_unchanged(key, study);
  key.study.folder = study.folder;
  if (key.simulated && !options.is_simulated()) {
    throw StoreError(file.string() +
                     ": is a simulated study's; give people another --db and a "
                     "prepared study");
  }
  engine::Pack pack(options.pack.empty() && is_there(key.pack_folder) ? key.pack_folder
                                                                      : place.pack);
  require_intact(pack, key);
  return {std::move(key), std::move(pack), has_key_in_reach(options, place)};
}

namespace {

store::StudyStore stored_study(const RunOptions& options, const RunStudy& study) {
  const store::StudyCommitment ours =
      session::commitment_of(study.key, study.pack, options.is_simulated(), options.pilot);
  if (!is_there(options.database)) {
    refuse_lost_database(options.database, ours, options.heads);
    return store::StudyStore::create(options.database, ours, utc_now(), study.key.signer());
  }
  store::StudyStore store =
      store::StudyStore::open(options.database, store::StudyStore::Access::read_write);
  require_same(store.commitment(), ours, options);
  if (store.stations() > 0) {
    refuse(options,
           "was merged from several stations' databases and takes no sessions of its own; run them "
           "in this station's database, and merge again");
  }
  store.sign_with(study.key.signer());
  return store;
}

/// Which of two clocks is wrong, only people can tell. In virtual time sessions are longer than
/// they took.
void warn_of_clock(const RunOptions& options, const store::StudyStore& store) {
  if (options.is_simulated() && !options.real_time) return;
  const auto last = store.last_event(0);
  if (!last || utc_now() >= last->at) return;
  spdlog::warn(
      "this machine's clock shows {}, which is before the last entry of {} ({}): one of them is "
      "wrong; set the clock if it is this one",
      utc_words(utc_now()), one_line(options.database.string()), utc_words(last->at));
}

}  // namespace

store::StudyStore run_database_for(const RunOptions& options, const RunStudy& study) {
  store::StudyStore store = stored_study(options, study);
  keep_heads(store, options.database, study.key.signer(), options.heads, HeadUse::required);
  warn_of_clock(options, store);
  if (!options.is_simulated() && !store.sessions().empty()) {
    print(head_words(store) + "; compare it with the last day sheet\n");
  }
  return store;
}

}  // namespace touchtrial::app
