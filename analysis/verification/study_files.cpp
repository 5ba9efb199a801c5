#include "analysis/verification/study_files.hpp"

#include "analysis/verification/head_check.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/damage.hpp"
#include "study/prepare.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace touchtrial::analysis {
namespace {

namespace fs = std::filesystem;

/// An opened file, or the state and reason to report for its check.
template <typename File>
struct Opened {
  std::optional<File> file;
  CheckState state = CheckState::not_checked;
  std::string reason;
};

/// Whether a file certainly does not exist. If its status is unknown, opening it reports the error.
bool is_absent(const fs::path& path) {
  std::error_code error;
  return fs::status(path, error).type() == fs::file_type::not_found;
}

template <typename File, typename Open>
Opened<File> try_to_open(Open open) {
  try {
    return {open(), CheckState::passed, ""};
  } catch (const Error& error) {
    return {std::nullopt, CheckState::failed, one_line(error.what())};
  }
}

Opened<study::StudyKey> open_key(const StudyFiles& files) {
  if (!files.key_named && files.key.empty()) {
    return {std::nullopt, CheckState::not_checked, "needs the key; name it with --key"};
  }
  if (!files.key_named && is_absent(files.key)) {
    return {std::nullopt, CheckState::not_checked,
            "there is no " + one_line(files.key.string()) + "; name the key with --key"};
  }
  return try_to_open<study::StudyKey>([&] { return study::load_study_key(files.key); });
}

bool has_code_of_key(const engine::Pack& pack, const study::StudyKey& key) {
  const auto& entries = pack.manifest().entries;
  return std::any_of(
      key.stimuli.begin(), key.stimuli.end(), [&](const study::KeyedStimulus& stimulus) {
        return std::any_of(entries.begin(), entries.end(), [&](const engine::PackEntry& entry) {
          return entry.code == stimulus.code;
        });
      });
}

/// Whether the pack in the key's folder was rebuilt since. It may then belong to another study, or
/// to an edited simulated study, whose identity follows from its unchanged seed. Stimulus codes are
/// random, so a pack with one of the key's codes belongs to this study, whatever identity it
/// states.
bool is_rebuilt_pack(const record::StudyStore& store, const study::StudyKey& key,
                     const engine::Pack& pack) {
  const record::StudyCommitment& commitment = store.commitment();
  const bool is_of_other_study = pack.manifest().study_id != commitment.study_id;
  if (!key.simulated) return is_of_other_study && !has_code_of_key(pack, key);
  return is_of_other_study || pack.digest() != commitment.pack;
}

Opened<engine::Pack> find_pack(const record::StudyStore& store, const study::StudyKey& key,
                               const fs::path& database) {
  const fs::path path = study::find_pack(key, database);
  const std::string folder = one_line(path.string());
  const auto not_checked = [](const std::string& reason) {
    return Opened<engine::Pack>{std::nullopt, CheckState::not_checked,
                                reason + "; name the pack with --pack"};
  };
  if (path.empty()) return not_checked("the key names no pack");
  if (is_absent(path)) {
    return not_checked("there is no " + folder + ", nor this pack beside the database or here");
  }
  Opened<engine::Pack> pack = try_to_open<engine::Pack>([&] { return engine::Pack(path); });
  try {
    if (pack.file && is_rebuilt_pack(store, key, *pack.file)) {
      return not_checked(folder + " was rebuilt for another study, or for this one after a change");
    }
  } catch (const StoreError&) {
    // The check of the chain reports an unreadable first event.
  }
  return pack;
}

Opened<engine::Pack> open_pack(const StudyFiles& files, const record::StudyStore& store,
                               const std::optional<study::StudyKey>& key) {
  if (!files.pack.empty())
    return try_to_open<engine::Pack>([&] { return engine::Pack(files.pack); });
  if (key) return find_pack(store, *key, files.database);
  return {std::nullopt, CheckState::not_checked, "needs the key, or --pack"};
}

template <typename File>
void replace_check(Verification& verification, const char* name, const Opened<File>& result) {
  if (result.file) return;
  const auto check = std::find_if(verification.checks.begin(), verification.checks.end(),
                                  [&](const Check& one) { return one.name == name; });
  if (check != verification.checks.end()) *check = {name, result.state, result.reason};
}

/// Adds the check of the head files to databases that have or had any.
/// \param head  the hash that the user wrote down; if it is the chain's end, missing head files are
///   a note, not a fault
void add_heads(const record::StudyStore& store, const StudyFiles& files, const std::string& head,
               Verification& verification) {
  HeadCheck heads = check_heads(store, files.database, files.heads);
  const bool is_end = !head.empty() && to_hex(store.file_head().hash).starts_with(head);
  if (is_end && !heads.missing_files.empty())
    verification.notes.push_back(std::exchange(heads.missing_files, {}));
  const std::string fault = heads.fault();
  verification.notes.insert(verification.notes.end(), heads.notes.begin(), heads.notes.end());
  if (heads.compared > 0 || !fault.empty()) {
    verification.checks.push_back({"heads", fault.empty() ? CheckState::passed : CheckState::failed,
                                   fault.empty() ? heads.words() : fault});
  } else if (!verification.simulated) {
    verification.notes.emplace_back("there is no head file beside it");
  }
}

/// Adds the check of a collected study's stations. Only head files show whether a missing station
/// has sessions, or whether a present one has later sessions.
void add_stations(const record::StudyStore& store, const StudyFiles& files,
                  const std::optional<study::StudyKey>& key, Verification& verification) {
  if (!key && files.heads.empty()) {
    verification.checks.push_back({"stations", CheckState::not_checked, "needs the key"});
    return;
  }
  if (key && key->stations.size() < 2 && files.heads.empty()) return;  // collected from one station
  std::map<std::string, PublicKey> signers;
  for (const study::Station& station : key ? key->stations : std::vector<study::Station>()) {
    signers[station.name] = study::station_key(*key, station.name).signer().public_half();
  }
  const StationsCheck stations = check_stations(store, signers, files.heads);
  Check check{"stations", CheckState::passed, "complete according to their head files"};
  if (!stations.unchecked_ends.empty()) {
    check.detail = "none is missing; compare with their day sheets or by --head-file: " +
                   stations.unchecked_ends;
  }
  if (!stations.absent.empty()) {
    check = {"stations", CheckState::not_checked,
             stations.absent +
                 " is absent, which is a loss unless it had no sessions; give its head file with "
                 "--head-file"};
  }
  if (!stations.missing.empty()) check = {"stations", CheckState::failed, stations.missing};
  verification.checks.push_back(std::move(check));
}

Verification damaged_verification(const record::DamagedStore& error) {
  constexpr std::array kSkippedChecks{"key",       "seal",     "configuration", "schedule",
                                      "responses", "payloads", "traces",        "pack"};
  Verification verification;
  verification.checks.push_back({"chain", CheckState::failed, one_line(error.what())});
  for (const char* name : kSkippedChecks) {
    verification.checks.push_back({name, CheckState::not_checked, "needs a readable database"});
  }
  return verification;
}

}  // namespace

Verification verify_files(const StudyFiles& files, const std::string& head) try {
  const record::StudyStore store =
      record::StudyStore::open(files.database, record::StudyStore::Access::read_only);
  const Opened<study::StudyKey> key = open_key(files);
  const Opened<engine::Pack> pack = open_pack(files, store, key.file);
  Verification verification =
      verify_study(store, key.file ? &*key.file : nullptr, pack.file ? &*pack.file : nullptr, head);
  replace_check(verification, "key", key);
  replace_check(verification, "pack", pack);
  if (store.stations() == 0) {
    add_heads(store, files, head, verification);
  } else {
    add_stations(store, files, key.file, verification);
  }
  return verification;
} catch (const record::DamagedStore& error) {
  return damaged_verification(error);
}

}  // namespace touchtrial::analysis
