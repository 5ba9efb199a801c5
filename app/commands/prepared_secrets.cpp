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

/// A new key would turn this into another study, and replace the station's file that its databases
/// need.
void refuse_new_key(const study::PackPlace& place) {
  const fs::path station = place.station();
  const fs::path found = is_there(station) ? station : place.pack;
  if (!is_there(station) && !is_there(place.pack / "pack.json")) return;
  throw FileError(place.key.string() + ": is not here, but " + found.string() +
                  " was made with it; put the key here, or make a new study in another folder with "
                  "--pack");
}

/// Another study's key, or a simulated one, is not replaced.
void require_own(const study::StudyKey& earlier, const study::Study& study, const fs::path& path) {
  if (earlier.simulated) {
    throw UsageError(path.string() +
                     ": is the key of a simulated study; give another folder with --pack");
  }
  if (earlier.study.name != study.name) {
    throw UsageError(path.string() + ": is the key of study \"" + earlier.study.name +
                     "\"; give another folder with --pack");
  }
}

/// The path to which the key of an earlier version of the study is moved.
fs::path aside_place(const fs::path& key, const Digest& seal) {
  constexpr std::size_t kSealDigits = 8;
  fs::path kept = key;
  kept += "." + to_hex(seal).substr(0, kSealDigits);
  return kept;
}

/// Removes drafts that a killed run left of this file, or of a file whose name starts with it.
void remove_drafts_of(const fs::path& file) {
  std::error_code ignored;
  const std::string beginning = file.filename().string() + ".";
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::vector<fs::path> left;
  for (const auto& found : fs::directory_iterator(folder, ignored)) {
    const std::string name = found.path().filename().string();
    if (name.starts_with(beginning) && name.find(kDraftEnding) != std::string::npos) {
      left.push_back(found.path());
    }
  }
  for (const fs::path& one : left) fs::remove(one, ignored);
}

/// The target of a link, or the file itself.
fs::path target_of(const fs::path& place) {
  std::error_code error;
  if (!fs::is_symlink(place, error)) return place;
  const fs::path target = fs::canonical(place, error);
  return error ? place : target;
}

bool is_same(const fs::path& draft, const fs::path& place) {
  return is_there(place) && read_file(draft) == read_file(place) &&
         fs::status(draft).permissions() == fs::status(place).permissions();
}

}  // namespace

PreparedSecrets::PreparedSecrets(const study::Study& study, const study::PackPlace& place,
                                 bool passphrase)
    : place_(place) {
  if (is_there(place.key)) {
    before_ = read_file(place.key);
    earlier_ = study::load_study_key(place.key);
    require_own(*earlier_, study, place.key);
    key_ = study::rekeyed(*earlier_, study);
  } else {
    refuse_new_key(place);
    SystemEntropy entropy;
    key_ = study::make_study_key(study, entropy, false);
  }
  key_.pack_folder = place.pack;
  draft_secrets(passphrase);
}

PreparedSecrets::Drafts::~Drafts() {
  for (const Draft& draft : in_order) remove_drafts_of(draft.place);
}

fs::path PreparedSecrets::draft_for(const fs::path& place) {
  const fs::path target = target_of(place);
  remove_drafts_of(target);
  fs::path file = target;
  file += kDraftEnding;
  drafts_.in_order.push_back({file, target});
  // A copy, so that a protected file keeps its passphrase.
  if (is_there(target)) replace_file(file, read_file(target), FileMode::owner_only);
  return file;
}

void PreparedSecrets::draft_secrets(bool passphrase) {
  const bool protects = passphrase && (is_new() || !study::is_protected(place_.key));
  const std::string chosen = protects ? new_passphrase(place_.key, passphrase_files()) : "";
  const auto save = [&](const fs::path& file, const study::StudyKey& key) {
    protects ? study::save_study_key(file, key, chosen) : study::save_study_key(file, key);
  };
  const fs::path draft_of_key = draft_for(place_.key);
  if (earlier_ && earlier_->seal != key_.seal) {
    const fs::path kept = draft_for(aside_place(target_of(place_.key), earlier_->seal));
    replace_file(kept, before_, FileMode::owner_only);
    if (protects) save(kept, *earlier_);
    std::swap(drafts_.in_order[0], drafts_.in_order[1]);
  }
  save(draft_of_key, key_);
  for (const study::Station& station : key_.stations) {
    study::save_station_key(draft_for(place_.station(station.name)),
                            study::station_key(key_, station.name));
  }
}

void PreparedSecrets::publish() {
  const Bytes now = is_there(place_.key) ? read_file(place_.key) : Bytes();
  const auto refuse = [&] {
    throw FileError(one_line(place_.key.string()) +
                    ": another program has written the key meanwhile; run `touchtrial prepare` "
                    "again");
  };
  if (now != before_) refuse();
  for (const Draft& draft : drafts_.in_order) {
    if (is_same(draft.file, draft.place)) continue;
    if (is_new() && draft.place == target_of(place_.key)) {
      if (!move_to_free_name(draft.file, draft.place)) refuse();
      continue;
    }
    rename_file(draft.file, draft.place);
  }
  if (!earlier_ || earlier_->seal == key_.seal) return;
  spdlog::warn(
      "{}: the study has changed; the earlier key is kept as {}, because databases that it sealed "
      "need it",
      place_.key.string(), aside_place(place_.key, earlier_->seal).string());
}

}  // namespace touchtrial::app
