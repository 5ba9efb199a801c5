/// \file A new folder that a command fills.
#pragma once

#include <filesystem>

namespace touchtrial::app {

/// A created folder, removed again with its content and the parents created for it, unless `keep`
/// is called.
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
  std::filesystem::path first_;  ///< the topmost created folder
  bool had_;                     ///< it existed, and was empty
  bool is_kept_ = false;
};

/// Checks that a folder can be created under this name.
/// \throws UsageError if the name is empty, or of a file, or of a non-empty folder
void require_free(const std::filesystem::path& folder);

}  // namespace touchtrial::app
