/// \file Files and folders that are written under a temporary name and renamed when complete.
#pragma once

#include "core/bytes.hpp"
#include "core/files.hpp"

#include <filesystem>

namespace touchtrial {

/// Refuses a symbolic link in place of a file, because it may lead to any other file. Links among
/// the parent folders are allowed.
/// \throws FileError naming the link and its target
void refuse_link(const std::filesystem::path& path);

/// Makes the names in a folder survive a power cut.
void sync_folder(const std::filesystem::path& folder) noexcept;

/// A temporary file or folder in the folder of its final path, named
/// ".touchtrial-PROCESS-NUMBER.tmp". It stays locked while its process runs. The first draft that a
/// process creates in a folder removes drafts left there by killed processes. Not thread-safe.
class Draft {
 public:
  enum class Kind { file, folder };

  /// Creates an empty draft.
  /// \throws FileError with the system's reason; nothing is left behind
  Draft(std::filesystem::path final_path, Kind kind, FileMode mode = FileMode::everyone);
  /// Removes the draft, with the content of a folder, unless it was renamed.
  ~Draft();
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// The open file descriptor of the draft.
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

  /// Writes the whole file and syncs it.
  /// \throws FileError with the system's reason
  void write(ByteView content) const;
  /// Renames the draft to its final path, replacing a file that exists there.
  /// \throws FileError with the system's reason
  void replace();
  /// Renames the draft to its final path unless something exists there.
  /// \return whether it was renamed
  /// \throws FileError with the system's reason
  [[nodiscard]] bool rename_if_free();

 private:
  [[nodiscard]] bool make(Kind kind, FileMode mode);

  std::filesystem::path final_path_;
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace touchtrial
