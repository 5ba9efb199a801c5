#include "app/commands/prepared_secrets.hpp"

#include "app/terminal/passphrases.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "study/key_protection.hpp"

#include <cstddef>
#include <system_error>

#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDraftEnding = ".unfinished";

/// Refuses a new key for a prepared study: it would make another study, and replace the station's
/// file that its databases need.
void refuse_new_key(const study::PackPlace& place) {
  const fs::path station = place.station();
  const fs::path existing_file = path_exists(station) ? station : place.pack;
  if (!path_exists(station) && !path_exists(place.pack / "pack.json")) return;
  throw FileError(place.key.string() + ": does not exist, but " + existing_file.string() +
                  " was made with this key; restore it, or make a new study in another folder with "
                  "--pack");
}

/// Refuses to replace the key of another study or a simulated one.
void require_key_of(const study::StudyKey& previous_key, const study::Study& study,
                    const fs::path& path) {
  if (previous_key.simulated) {
    throw UsageError(path.string() +
                     ": is the key of a simulated study; give another folder with --pack");
  }
  if (previous_key.study.name != study.name) {
    throw UsageError(path.string() + ": is the key of study \"" + previous_key.study.name +
                     "\"; give another folder with --pack");
  }
}

/// The path to which the key of an earlier version of the study is moved.
fs::path backup_path(const fs::path& key, const Digest& seal) {
  constexpr std::size_t kSealDigits = 8;
  fs::path backup = key;
  backup += "." + to_hex(seal).substr(0, kSealDigits);
  return backup;
}

/// Removes the drafts that a killed run left of this file, or of files named after it.
void remove_drafts_of(const fs::path& file) {
  std::error_code ignored;
  const std::string prefix = file.filename().string() + ".";
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::vector<fs::path> leftover_drafts;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.find(kDraftEnding) != std::string::npos) {
      leftover_drafts.push_back(entry.path());
    }
  }
  for (const fs::path& draft : leftover_drafts) fs::remove(draft, ignored);
}

/// The target of a link, or the file itself.
fs::path target_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path target = fs::canonical(path, error);
  return error ? path : target;
}

bool are_identical(const fs::path& draft, const fs::path& target) {
  return path_exists(target) && read_file(draft) == read_file(target) &&
         fs::status(draft).permissions() == fs::status(target).permissions();
}

}  // namespace

PreparedSecrets::PreparedSecrets(const study::Study& study, const study::PackPlace& place,
                                 bool passphrase)
    : place_(place) {
  if (path_exists(place.key)) {
    previous_bytes_ = read_file(place.key);
    previous_key_ = study::load_study_key(place.key);
    require_key_of(*previous_key_, study, place.key);
    key_ = study::rekeyed(*previous_key_, study);
  } else {
    refuse_new_key(place);
    SystemEntropy entropy;
    key_ = study::make_study_key(study, entropy, false);
  }
  key_.pack_folder = place.pack;
  draft_secrets(passphrase);
}

PreparedSecrets::Drafts::~Drafts() {
  for (const Draft& draft : list) remove_drafts_of(draft.target);
}

fs::path PreparedSecrets::draft_for(const fs::path& path) {
  const fs::path target = target_of(path);
  remove_drafts_of(target);
  fs::path file = target;
  file += kDraftEnding;
  drafts_.list.push_back({file, target});
  // A copy, so that a protected file keeps its passphrase.
  if (path_exists(target)) replace_file(file, read_file(target), FileMode::owner_only);
  return file;
}

void PreparedSecrets::draft_secrets(bool passphrase) {
  const bool adds_passphrase = passphrase && (is_new() || !study::is_protected(place_.key));
  const std::string new_secret =
      adds_passphrase ? new_passphrase(place_.key, passphrase_files()) : "";
  const auto save = [&](const fs::path& file, const study::StudyKey& key) {
    adds_passphrase ? study::save_study_key(file, key, new_secret)
                    : study::save_study_key(file, key);
  };
  const fs::path key_draft = draft_for(place_.key);
  if (previous_key_ && previous_key_->seal != key_.seal) {
    const fs::path backup = draft_for(backup_path(target_of(place_.key), previous_key_->seal));
    replace_file(backup, previous_bytes_, FileMode::owner_only);
    if (adds_passphrase) save(backup, *previous_key_);
    std::swap(drafts_.list[0], drafts_.list[1]);
  }
  save(key_draft, key_);
  for (const study::Station& station : key_.stations) {
    study::save_station_key(draft_for(place_.station(station.name)),
                            study::station_key(key_, station.name));
  }
}

void PreparedSecrets::publish() {
  const Bytes current = path_exists(place_.key) ? read_file(place_.key) : Bytes();
  const auto refuse = [&] {
    throw FileError(
        one_line(place_.key.string()) +
        ": another program has written the key in the meantime; run `touchtrial prepare` "
        "again");
  };
  if (current != previous_bytes_) refuse();
  for (const Draft& draft : drafts_.list) {
    if (are_identical(draft.file, draft.target)) continue;
    if (is_new() && draft.target == target_of(place_.key)) {
      if (!move_to_free_name(draft.file, draft.target)) refuse();
      continue;
    }
    rename_file(draft.file, draft.target);
  }
  if (!previous_key_ || previous_key_->seal == key_.seal) return;
  spdlog::warn(
      "{}: the study has changed; the previous key is kept as {}, because databases sealed with it "
      "need it",
      place_.key.string(), backup_path(place_.key, previous_key_->seal).string());
}

}  // namespace touchtrial::app
