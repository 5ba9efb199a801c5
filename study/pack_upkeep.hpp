/// \file Maintenance of a pack's folder: reuse of fields from earlier runs, drafts, and removal of
/// leftovers. Private to study. Call these functions only while the pack is locked.
#pragma once

#include "engine/pack/pack.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::study {

/// The file of a code's field.
[[nodiscard]] std::filesystem::path field_path(const std::filesystem::path& folder,
                                               const std::string& code);

/// The folder of unfinished fields and their manifest. It is in the pack's folder, so that fields
/// can be moved by renaming. Its manifest has no seal, so that no session presents these fields.
[[nodiscard]] std::filesystem::path draft_folder(const std::filesystem::path& folder);

/// A field from an earlier run, which need not be rebuilt.
struct ReusableField {
  engine::PackEntry entry;
  bool is_draft = false;  ///< whether it is among the drafts, not in the pack
};

/// Fields of a study from earlier runs: those of its pack, and drafts of an interrupted run. Only
/// manifests signed with the key are used.
class EarlierFields {
 public:
  /// A simulated study ignores and replaces another study's pack, because a simulated pack can be
  /// rebuilt from its study file.
  /// \throws FileError if the study is not simulated and the folder contains another study's pack
  EarlierFields(const std::filesystem::path& folder, const StudyKey& key);

  /// \return an intact field made from this input, if there is one
  [[nodiscard]] std::optional<ReusableField> find(const std::string& code, const Digest& tag) const;
  /// Whether the pack lists a field made from this input. If `find` nevertheless returns nothing,
  /// the field's file is damaged.
  [[nodiscard]] bool lists_field(const std::string& code, const Digest& tag) const;
  [[nodiscard]] bool has_manifest(const engine::PackManifest& manifest) const {
    return pack_ == manifest;
  }
  [[nodiscard]] const std::vector<engine::PackEntry>& drafts() const noexcept {
    return drafts_.entries;
  }
  /// Why the pack was not used; empty if it was used or there was none.
  [[nodiscard]] const std::string& damage() const noexcept { return damage_; }

 private:
  std::filesystem::path folder_;
  engine::PackManifest pack_;
  engine::PackManifest drafts_;
  std::string damage_;
};

/// Removes the drafts, fields that the manifest does not name, and temporary files of interrupted
/// runs. Keeps all other files.
void remove_leftovers(const std::filesystem::path& folder, const engine::PackManifest& manifest);

}  // namespace touchtrial::study
