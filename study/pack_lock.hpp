/// \file The lock of a pack's folder: one process prepares the pack, or any number read it.
#pragma once

#include <filesystem>

namespace touchtrial::study {

/// Holds `prepare.lock` in the pack's folder. The system releases it however the process ends.
class PackLock {
 public:
  enum class Use { prepare, read };
  enum class Wait { no, yes };

  /// To prepare, makes the folder if it is missing. To read, makes nothing: where there is no
  /// `prepare.lock`, nobody has prepared, and nothing is locked.
  /// \param wait  whether to wait for other processes and threads
  /// \throws FileError if another one holds it and is not waited for, or the file cannot be made
  explicit PackLock(std::filesystem::path folder, Use use = Use::prepare, Wait wait = Wait::no);
  /// Unlocks all. Removes the folder again if this lock made it and nothing was put into it.
  ~PackLock();
  PackLock(const PackLock&) = delete;
  PackLock& operator=(const PackLock&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// Locks the place of a key too, which two packs may share, with `<key>.lock` beside it.
  /// \throws FileError if another process holds it, or the file cannot be made
  void lock_key(const std::filesystem::path& key);

 private:
  std::filesystem::path folder_;
  std::filesystem::path key_file_;
  bool made_ = false;
  int descriptor_ = -1;
  int key_descriptor_ = -1;
};

}  // namespace touchtrial::study
