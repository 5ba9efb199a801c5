/// \file One writer at a time for a pack. Private to protocols/design.
#pragma once

#include <filesystem>

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

}  // namespace touchtrial::design
