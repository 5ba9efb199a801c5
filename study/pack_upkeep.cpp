#include "study/pack_upkeep.hpp"

#include "core/errors.hpp"
#include "study/signed_pack.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

namespace touchtrial::study {
namespace {

constexpr std::string_view kManifestName = "pack.json";
constexpr std::string_view kFieldEnding = ".field";

/// \return the code in the file name of a field, or nothing for any other file name
std::optional<std::string> code_of_file(std::string_view name) {
  if (!name.ends_with(kFieldEnding)) return std::nullopt;
  name.remove_suffix(kFieldEnding.size());
  if (!engine::is_pack_code(name)) return std::nullopt;
  return std::string(name);
}

bool names_code(const engine::PackManifest& manifest, const std::string& code) {
  return std::ranges::find(manifest.entries, code, &engine::PackEntry::code) !=
         manifest.entries.end();
}

/// \return null if the manifest has no such field made from this input
const engine::PackEntry* entry_of(const engine::PackManifest& manifest, const std::string& code,
                                  const Digest& tag) {
  const auto found = std::ranges::find(manifest.entries, code, &engine::PackEntry::code);
  return found == manifest.entries.end() || found->input_tag != tag ? nullptr : &*found;
}

bool has_bytes_of(const engine::PackEntry& entry, const std::filesystem::path& folder) {
  const std::filesystem::path file = field_path(folder, entry.code);
  try {
    return path_exists(file) && sha256_of_file(file) == entry.checksum;
  } catch (const FileError&) {
    return false;  // an unreadable field is rebuilt
  }
}

/// Codes are random, so a manifest that names one of the key's codes belongs to this study,
/// whatever identity it states.
bool belongs_to_other_key(const engine::PackManifest& manifest, const StudyKey& key) {
  return manifest.study_id != key.study_id &&
         std::ranges::none_of(key.stimuli, [&](const KeyedStimulus& keyed) {
           return names_code(manifest, keyed.code);
         });
}

}  // namespace

std::filesystem::path field_path(const std::filesystem::path& folder, const std::string& code) {
  return folder / (code + std::string(kFieldEnding));
}

std::filesystem::path draft_folder(const std::filesystem::path& folder) {
  return folder / "prepare.drafts";
}

EarlierFields::EarlierFields(const std::filesystem::path& folder, const StudyKey& key)
    : folder_(folder) {
  if (std::filesystem::exists(folder / kManifestName)) {
    try {
      pack_ = engine::Pack(folder).manifest();
    } catch (const FileError& error) {
      damage_ = error.what();
      damage_.erase(damage_.rfind("; "));  // prepare itself is the remedy
    }
    if (damage_.empty() && belongs_to_other_key(pack_, key)) {
      if (!key.simulated) {
        throw FileError(one_line(folder.string()) +
                        ": contains the pack of another key; choose another folder with --pack, or "
                        "delete this one if its key is lost");
      }
      pack_ = {};
    } else if (damage_.empty() && !is_signed(pack_, key.investigator_signature)) {
      damage_ = one_line((folder / kManifestName).string()) + ": was altered since it was signed";
      pack_ = {};
    }
  }
  try {
    drafts_ = engine::Pack(draft_folder(folder)).manifest();
    if (!is_signed(drafts_, key.investigator_signature)) drafts_ = {};
  } catch (const FileError&) {
    // There was no interrupted run, or it ended before it had finished a field.
  }
}

std::optional<ReusableField> EarlierFields::find(const std::string& code, const Digest& tag) const {
  for (const engine::PackManifest* list : {&pack_, &drafts_}) {
    const engine::PackEntry* const entry = entry_of(*list, code, tag);
    if (entry == nullptr) continue;
    if (has_bytes_of(*entry, folder_)) return ReusableField{*entry, false};
    if (has_bytes_of(*entry, draft_folder(folder_))) return ReusableField{*entry, true};
  }
  return std::nullopt;
}

bool EarlierFields::lists_field(const std::string& code, const Digest& tag) const {
  return entry_of(pack_, code, tag) != nullptr;
}

void remove_leftovers(const std::filesystem::path& folder, const engine::PackManifest& manifest) {
  std::error_code ignored;  // a remaining leftover does no harm
  std::filesystem::remove_all(draft_folder(folder), ignored);
  std::vector<std::filesystem::path> leftovers;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    const auto code = code_of_file(name);
    if (code && !names_code(manifest, *code)) leftovers.push_back(file.path());
  }
  for (const auto& path : leftovers) std::filesystem::remove(path, ignored);
}

}  // namespace touchtrial::study
