/// \file A folder that a command creates and fills.
#pragma once

#include <filesystem>

namespace touchtrial::app {

/// A created folder, removed again with its content and the parents created for it, unless `keep`
/// is called.
class NewFolder {
 public:
  /// \throws as require_free; FileError if the folder cannot be created
  explicit NewFolder(const std::filesystem::path& folder);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  void keep() noexcept { is_kept_ = true; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path topmost_;  ///< the topmost created folder
  bool existed_;                   ///< whether the folder existed before, empty
  bool is_kept_ = false;
};

/// Checks that a folder can be created under this name.
/// \throws UsageError if the name is empty, or names a file or a non-empty folder
void require_free(const std::filesystem::path& folder);

}  // namespace touchtrial::app
