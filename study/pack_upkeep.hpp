/// \file Upkeep of a pack's folder: reuse of what earlier runs left, drafts, and removal of
/// leftovers. Private to study. Call all of it only while the pack is locked.
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

/// Where fields and a list of them lie until all is complete: in the pack's folder, so that they
/// can be renamed into their places. The list has no seal while it is not complete, so that nothing
/// is presented from there.
[[nodiscard]] std::filesystem::path draft_folder(const std::filesystem::path& folder);

/// A field that need not be built.
struct FoundField {
  engine::PackEntry entry;
  bool is_draft = false;  ///< whether it lies among the drafts
};

/// What earlier runs left of a study's pack: the pack, and drafts of a run that was broken off, at
/// whatever point. Only lists that the key signed are believed.
class EarlierFields {
 public:
  /// A simulated study ignores and replaces another study's pack, because simulated packs can be
  /// made again from the study file.
  /// \throws FileError if the study is not simulated and the folder holds another study's pack
  EarlierFields(const std::filesystem::path& folder, const StudyKey& key);

  /// \return an intact field made from this input, if there is one
  [[nodiscard]] std::optional<FoundField> find(const std::string& code, const Digest& tag) const;
  /// Whether the pack names a field made from this input; its file is damaged if `find` finds none.
  [[nodiscard]] bool names(const std::string& code, const Digest& tag) const;
  [[nodiscard]] bool has(const engine::PackManifest& manifest) const { return pack_ == manifest; }
  [[nodiscard]] const std::vector<engine::PackEntry>& drafts() const noexcept {
    return drafts_.entries;
  }
  /// Why nothing of the pack was believed; empty if it was, or there was none.
  [[nodiscard]] const std::string& damage() const noexcept { return damage_; }

 private:
  std::filesystem::path folder_;
  engine::PackManifest pack_;
  engine::PackManifest drafts_;
  std::string damage_;
};

/// Removes the drafts, fields that the manifest does not name, and what interrupted writers left.
/// Keeps all other files.
void remove_leftovers(const std::filesystem::path& folder, const engine::PackManifest& manifest);

}  // namespace touchtrial::study
