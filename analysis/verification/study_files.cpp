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

/// An opened file, or the result to report instead of its check.
template <typename File>
struct Opened {
  std::optional<File> file;
  CheckState state = CheckState::not_checked;
  std::string why;
};

/// Whether a file certainly does not exist. A file whose status is unknown fails when it is opened.
bool is_absent(const fs::path& path) {
  std::error_code error;
  return fs::status(path, error).type() == fs::file_type::not_found;
}

template <typename File, typename Open>
Opened<File> opened(Open open) {
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
  return opened<study::StudyKey>([&] { return study::load_study_key(files.key); });
}

bool has_code_of(const study::StudyKey& key, const engine::Pack& pack) {
  const auto& entries = pack.manifest().entries;
  return std::any_of(
      key.stimuli.begin(), key.stimuli.end(), [&](const study::KeyedStimulus& stimulus) {
        return std::any_of(entries.begin(), entries.end(), [&](const engine::PackEntry& entry) {
          return entry.code == stimulus.code;
        });
      });
}

/// Whether the key's pack has since been rebuilt. It may now belong to another study, or to an
/// edited simulated study, whose identity is the same because its seed is. Stimulus codes are
/// random, so a pack with one of the key's codes belongs to this study, whatever identity it
/// states.
bool was_rebuilt(const record::StudyStore& store, const study::StudyKey& key,
                 const engine::Pack& pack) {
  const record::StudyCommitment& commitment = store.commitment();
  const bool is_of_other = pack.manifest().study_id != commitment.study_id;
  if (!key.simulated) return is_of_other && !has_code_of(key, pack);
  return is_of_other || pack.digest() != commitment.pack;
}

Opened<engine::Pack> find_pack(const record::StudyStore& store, const study::StudyKey& key,
                               const fs::path& database) {
  const fs::path place = study::find_pack(key, database);
  const std::string folder = one_line(place.string());
  const auto leave = [](const std::string& why) {
    return Opened<engine::Pack>{std::nullopt, CheckState::not_checked,
                                why + "; name the pack with --pack"};
  };
  if (place.empty()) return leave("the key names no pack");
  if (is_absent(place)) {
    return leave("there is no " + folder + ", nor this pack beside the database or here");
  }
  Opened<engine::Pack> pack = opened<engine::Pack>([&] { return engine::Pack(place); });
  try {
    if (pack.file && was_rebuilt(store, key, *pack.file)) {
      return leave(folder + " was rebuilt for another study, or for this one after a change");
    }
  } catch (const StoreError&) {
    // The check of the chain reports a first event that cannot be read.
  }
  return pack;
}

Opened<engine::Pack> open_pack(const StudyFiles& files, const record::StudyStore& store,
                               const std::optional<study::StudyKey>& key) {
  if (!files.pack.empty()) return opened<engine::Pack>([&] { return engine::Pack(files.pack); });
  if (key) return find_pack(store, *key, files.database);
  return {std::nullopt, CheckState::not_checked, "needs the key, or --pack"};
}

template <typename File>
void put(Verification& verification, const char* name, const Opened<File>& opened) {
  if (opened.file) return;
  const auto check = std::find_if(verification.checks.begin(), verification.checks.end(),
                                  [&](const Check& one) { return one.name == name; });
  if (check != verification.checks.end()) *check = {name, opened.state, opened.why};
}

/// Adds the check of the head files: missing ends and missing files. Only for databases that have
/// or had head files.
/// \param head  the hash that the user wrote down; if it is the chain's end, missing head files are
///   not reported
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

/// Adds the check of a collected study's stations. Only their head files show whether a missing
/// station has sessions, or a station has later ones.
void add_stations(const record::StudyStore& store, const StudyFiles& files,
                  const std::optional<study::StudyKey>& key, Verification& verification) {
  if (!key && files.heads.empty()) {
    verification.checks.push_back({"stations", CheckState::not_checked, "needs the key"});
    return;
  }
  if (key && key->stations.size() < 2 && files.heads.empty()) return;  // parts of one station
  std::map<std::string, PublicKey> signers;
  for (const study::Station& station : key ? key->stations : std::vector<study::Station>()) {
    signers[station.name] = study::station_key(*key, station.name).signer().public_half();
  }
  const StationsCheck stations = check_stations(store, signers, files.heads);
  Check check{"stations", CheckState::passed, "complete according to their head files"};
  if (!stations.ends.empty()) {
    check.detail =
        "none is missing; compare with their day sheets or by --head-file: " + stations.ends;
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

Verification of_damaged(const record::DamagedStore& error) {
  constexpr std::array kOthers{"key",       "seal",     "configuration", "schedule",
                               "responses", "payloads", "traces",        "pack"};
  Verification verification;
  verification.checks.push_back({"chain", CheckState::failed, one_line(error.what())});
  for (const char* name : kOthers) {
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
  put(verification, "key", key);
  put(verification, "pack", pack);
  if (store.stations() == 0) {
    add_heads(store, files, head, verification);
  } else {
    add_stations(store, files, key.file, verification);
  }
  return verification;
} catch (const record::DamagedStore& error) {
  return of_damaged(error);
}

}  // namespace touchtrial::analysis
