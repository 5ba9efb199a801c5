/// \file A new folder that a command fills.
#pragma once

#include <filesystem>

namespace touchtrial::app {

/// A folder that is made, and is gone again with what is in it, and folders above it that were made
/// for it, unless it is kept.
class MadeFolder {
 public:
  /// \throws as require_free; FileError if the folder cannot be made
  explicit MadeFolder(const std::filesystem::path& folder);
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

  void keep() noexcept { is_kept_ = true; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path first_;  ///< the topmost that is made
  bool had_;                     ///< it was there, and empty
  bool is_kept_ = false;
};

/// Whether something new can be made under this name.
/// \throws UsageError if the name is empty, or a file's, or a folder's with something in it
void require_free(const std::filesystem::path& folder);

}  // namespace touchtrial::app
