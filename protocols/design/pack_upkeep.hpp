/// \file Upkeep of a pack's folder: the lock for one writer at a time, reuse of an earlier pack's
/// fields, and removal of leftovers. Private to protocols/design.
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace touchtrial::design {

/// Holds `prepare.lock` in the pack's folder. The system releases it however the process ends.
class PackLock {
 public:
  /// \param wait  whether to wait while another process or thread prepares this pack
  /// \throws FileError if another one prepares it and `wait` is false, or the file cannot be made
  explicit PackLock(const std::filesystem::path& folder, bool wait = false);
  ~PackLock();
  PackLock(const PackLock&) = delete;
  PackLock& operator=(const PackLock&) = delete;

 private:
  int descriptor_;
};

/// The file of a code's field.
[[nodiscard]] std::filesystem::path field_path(const std::filesystem::path& folder,
                                               const std::string& code);

/// The identity of a pack while it is being built. Because it differs from the study's identity,
/// nothing is presented from such a pack; the next `prepare` recognises it and completes the pack.
[[nodiscard]] std::string unfinished_id(const StudyKey& key);

/// What the folder contained before this run.
struct EarlierPack {
  std::optional<engine::Pack> pack;  ///< of this study, finished or not
  std::string damage;  ///< why the table of contents was unusable; empty if it was usable

  /// \return the entry of the intact field made from this input, if there is one
  [[nodiscard]] std::optional<engine::PackEntry> reusable(const std::string& code,
                                                          const Digest& tag) const;
};

/// Opens the pack that is already in the folder. A simulated study ignores and replaces another
/// study's pack, because simulated packs can be made again from the study file.
/// \throws FileError if the study is not simulated and the folder holds another study's pack
[[nodiscard]] EarlierPack earlier_pack(const std::filesystem::path& folder, const StudyKey& key);

/// Removes fields that the manifest does not name, and drafts that interrupted writers left.
/// Keeps all other files. Call only while the pack is locked.
void remove_leftovers(const std::filesystem::path& folder, const engine::PackManifest& manifest);

}  // namespace touchtrial::design
