#include "app/run/run_study.hpp"

#include "app/commands/study_inputs.hpp"
#include "app/run/session_bounds.hpp"
#include "app/terminal/console.hpp"
#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/utc.hpp"
#include "protocols/session/commitment.hpp"
#include "record/head_file.hpp"
#include "study/key_protection.hpp"
#include "study/pack_lock.hpp"
#include "study/signed_pack.hpp"

#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

std::filesystem::path station_file_of(const RunOptions& options, const study::PackPlace& place) {
  return options.station_file.empty() ? place.station(options.station) : options.station_file;
}

/// Refuses a protected file of another station than the database's before asking for its
/// passphrase.
study::StationKey station_key_at(const RunOptions& options, const fs::path& file) {
  if (!study::is_protected(file) || !path_exists(options.database)) {
    return study::load_station_key(file);
  }
  const record::StudyStore store =
      record::StudyStore::open(options.database, record::StudyStore::Access::read_only);
  return station_key_for(store.commitment(), options.database, file);
}

/// The path of an investigator's key at this station, where it should not be because it decrypts
/// everything; empty: none.
fs::path reachable_key(const RunOptions& options, const study::PackPlace& place) {
  return options.is_simulated() || !path_exists(place.key) ? fs::path() : place.key;
}

/// Maps the pack under a lock against preparation, so that the session has one complete pack.
/// \param key  moved from
RunStudy open_pack(study::StationKey&& key, const fs::path& pack_folder,
                   study::PackLock::Wait wait) {
  const study::PackLock lock(pack_folder, study::PackLock::Use::read, wait);
  engine::Pack pack(pack_folder);
  study::require_complete_pack(pack, key);
  session::StimulusSource source(pack, key);
  return {std::move(key), std::move(pack), std::move(source)};
}

[[noreturn]] void refuse(const RunOptions& options, const std::string& reason) {
  throw StoreError(options.database.string() + ": " + reason);
}

/// \throws StoreError if no database can be created there
void require_free_name(const RunOptions& options) {
  refuse_link(options.database);
  const fs::path folder = options.database.parent_path();
  if (folder.empty() || path_exists(folder)) return;
  refuse(options, "its folder does not exist; create it, or give another --db");
}

void require_same_study(const record::StudyCommitment& stored, const std::string& study_id,
                        const Digest& seal, const RunOptions& options) {
  if (stored.study_id == study_id && stored.seal == seal) return;
  refuse(options,
         "is the database of another study, or of this one before it was prepared again; "
         "give another --db");
}

/// Checks that are possible before a pack is created.
void check_before_pack(const RunOptions& options, const study::Study& study,
                       const study::StudyKey& key) {
  static_cast<void>(subject_for(*options.subject, study, options.hand_device));
  require_planned_visit(options, study);
  if (options.heads.folder) {
    static_cast<void>(record::HeadFiles(options.database, {}, options.heads.folder));
  }
  refuse_other_key(key_path_for(options.database, {}), key);
  if (!path_exists(options.database)) {
    require_free_name(options);
    return;
  }
  const record::StudyStore store =
      record::StudyStore::open(options.database, record::StudyStore::Access::read_only);
  require_same_study(store.commitment(), key.study_id, key.seal, options);
}

RunStudy simulated_study(const RunOptions& options, const study::Study& study) {
  study::StudyKey key = simulated_key(study, options.study);
  check_before_pack(options, study, key);
  prepare_simulated_pack(key);
  RunStudy result = open_pack(study::station_key(key, study::kOnlyStation), key.pack_folder,
                              study::PackLock::Wait::yes);
  result.new_key = std::move(key);
  return result;
}

void require_same_commitment(const record::StudyCommitment& stored,
                             const record::StudyCommitment& expected, const RunOptions& options) {
  require_same_study(stored, expected.study_id, expected.seal, options);
  if (stored.investigator != expected.investigator) {
    refuse(options,
           "belongs to another investigator than the station's file; copy that file again from the "
           "investigator's machine, or give another --db");
  }
  if (stored.station && stored.station != expected.station) {
    refuse(options, "is the database of station " + one_line(stored.station->name) +
                        "; give another --db, or that station's file with --station-file");
  }
  if (stored.pack != expected.pack) {
    refuse(options, "was started with another pack; name that pack with --pack");
  }
  if (stored.pilot != expected.pilot) {
    refuse(options, stored.pilot ? "is the database of a pilot; give --pilot, or another --db"
                                 : "is not a pilot's database; give pilot sessions another --db");
  }
  if (stored.simulated != expected.simulated) {
    refuse(options, stored.simulated
                        ? "contains simulated participants; give people another --db"
                        : "contains people's sessions; give simulated participants another --db");
  }
}

}  // namespace

RunStudy run_study_for(const RunOptions& options) {
  const study::Study study = study::load_study(options.study);
  const study::PackPlace place = pack_place_for(options.study, options.pack);
  const fs::path file = station_file_of(options, place);
  if (!path_exists(file)) {
    if (options.is_simulated() && options.pack.empty() && !path_exists(place.pack)) {
      return simulated_study(options, study);
    }
    if (!path_exists(place.key) && !path_exists(place.pack)) {
      throw UsageError(
          one_line(options.study.string()) + ": is not prepared yet; run `touchtrial prepare " +
          one_line(options.study.string()) + "`, or copy the station's file and the pack here");
    }
    throw UsageError(one_line(file.string()) +
                     ": does not exist; name this station with --station, or copy its "
                     "file here from the investigator's machine, where `touchtrial prepare` writes "
                     "it again");
  }
  study::StationKey key = station_key_at(options, file);
  if (!study::are_same(key.study, study)) {
    throw StudyError(study::mismatch_of(study, key, file, "--station-file"));
  }
  key.study.folder = study.folder;
  if (key.simulated && !options.is_simulated()) {
    throw StoreError(file.string() +
                     ": belongs to a simulated study; give people another --db and a "
                     "prepared study");
  }
  const fs::path pack =
      options.pack.empty() && path_exists(key.pack_folder) ? key.pack_folder : place.pack;
  RunStudy result = open_pack(std::move(key), pack, study::PackLock::Wait::no);
  result.reachable_key = reachable_key(options, place);
  return result;
}

namespace {

/// Warns only, because either of the two clocks may be wrong. Virtual time runs ahead of the clock.
void warn_of_clock(const RunOptions& options, const record::StudyStore& store) {
  if (options.is_simulated() && !options.real_time) return;
  const auto last_event = store.last_event(0);
  if (!last_event || utc_now() >= last_event->at) return;
  spdlog::warn(
      "this machine's clock shows {}, which is before the last entry of {} ({}): one of them is "
      "wrong; set the clock if it is this one",
      utc_words(utc_now()), one_line(options.database.string()), utc_words(last_event->at));
}

/// Checks the paths of head files before the database is created.
void require_head_places(const RunOptions& options, const record::StudyCommitment& commitment) {
  const record::HeadFiles heads(options.database, record::head_signers(commitment),
                                options.heads.folder);
  for (const fs::path& head : heads.paths()) {
    refuse_link(head);
    const Draft test_draft(head, Draft::Kind::file);
  }
}

}  // namespace

RunDatabase::RunDatabase(const RunOptions& options, const RunStudy& study)
    : options_(options),
      study_(study),
      commitment_(
          session::commitment_of(study.key, study.pack, options.is_simulated(), options.pilot)) {
  if (path_exists(options.database)) {
    open();
    return;
  }
  require_free_name(options);
  refuse_lost_database(options.database, commitment_, options.heads);
}

void RunDatabase::open() {
  store_ = record::StudyStore::open(options_.database, record::StudyStore::Access::read_write);
  require_same_commitment(store_->commitment(), commitment_, options_);
  if (store_->stations() > 0) {
    refuse(options_,
           "was merged from several stations' databases and accepts no new sessions; run them "
           "in this station's database, and merge again");
  }
  lock_.emplace(options_.database, options_.participant);
  const Signer signer = study_.key.signer();
  store_->sign_with(signer);
  set_head_writer(*store_, options_.database, signer, options_.heads, HeadUse::required);
  warn_of_clock(options_, *store_);
  if (!options_.is_simulated() && !store_->sessions().empty()) {
    print(head_words(*store_) + "; compare it with the last day sheet\n");
  }
}

record::StudyStore& RunDatabase::open_or_create() {
  if (store_) return *store_;
  if (path_exists(options_.database)) {
    open();  // created by another program in the meantime
    return *store_;
  }
  require_head_places(options_, commitment_);
  lock_.emplace(options_.database, options_.participant);
  // Written before the database, because a database without its key is useless.
  const fs::path key = key_path_for(options_.database, {});
  if (study_.new_key && !path_exists(key)) study::save_study_key(key, *study_.new_key);
  const Signer signer = study_.key.signer();
  store_ = record::StudyStore::create(options_.database, commitment_, utc_now(), signer);
  set_head_writer(*store_, options_.database, signer, options_.heads, HeadUse::required);
  return *store_;
}

}  // namespace touchtrial::app
