/// \file Care of a pack's folder: one writer at a time, what an earlier pack offers to the next
/// `prepare`, and what is left over. Private to protocols/design.
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace touchtrial::design {

/// Holds `prepare.lock` in the pack's folder; the system lets go of it however the process ends.
class PackLock {
 public:
  /// \param wait  as long as another process or thread prepares this pack
  /// \throws FileError if one does and `wait` is not set, or the file cannot be made
  explicit PackLock(const std::filesystem::path& folder, bool wait = false);
  ~PackLock();
  PackLock(const PackLock&) = delete;
  PackLock& operator=(const PackLock&) = delete;

 private:
  int descriptor_;
};

/// The identity that a pack has while it is being built: nothing is presented from such a pack,
/// because it is not the study's, and the next `prepare` knows it as its own.
[[nodiscard]] std::string unfinished_id(const StudyKey& key);

/// What lay in the folder before.
struct EarlierPack {
  std::optional<engine::Pack> pack;  ///< of this study, finished or not
  std::string damage;  ///< why a table of contents could not be used; empty if all is well

  /// The entry whose field is whole and made from this input.
  [[nodiscard]] const engine::PackEntry* reusable(const std::string& code, const Digest& tag) const;
  /// Of a field that is not reusable, for people who ask what was built.
  [[nodiscard]] std::string_view why_not_reusable(const std::string& code, const Digest& tag) const;

 private:
  /// The entry of a field made from this input, whole or not.
  [[nodiscard]] const engine::PackEntry* recorded(const std::string& code, const Digest& tag) const;
};

/// \throws FileError if the folder holds another study's pack. A simulated study replaces it:
///   simulated packs can be made again from the study file.
[[nodiscard]] EarlierPack earlier_pack(const std::filesystem::path& folder, const StudyKey& key);

/// Removes fields that the manifest does not name, and drafts of writers that were interrupted.
/// Other files stay. Only while the pack is locked.
void remove_leftovers(const std::filesystem::path& folder, const engine::PackManifest& manifest);

}  // namespace touchtrial::design
