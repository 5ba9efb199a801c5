/// \file The lock of a pack's folder: one process writes the pack, or any number of them read it.
#pragma once

#include <filesystem>

namespace touchtrial::study {

/// Holds `prepare.lock` in the pack's folder. The system releases it however the process ends.
class PackLock {
 public:
  enum class Use { prepare, read };
  enum class Wait { no, yes };

  /// For Use::prepare, creates the folder if it is missing. For Use::read, creates nothing: without
  /// a `prepare.lock` the pack was never prepared, and nothing is locked.
  /// \param wait  whether to wait for other processes and threads
  /// \throws FileError if another one holds the lock and `wait` is no, or if the file cannot be
  ///   created
  explicit PackLock(std::filesystem::path folder, Use use = Use::prepare, Wait wait = Wait::no);
  /// Releases all locks. Removes the folder if this lock created it and it is still empty.
  ~PackLock();
  PackLock(const PackLock&) = delete;
  PackLock& operator=(const PackLock&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// Locks a key as well, which two packs may share, with `<key>.lock` beside it.
  /// \throws FileError if another process holds that lock, or if the file cannot be created
  void lock_key(const std::filesystem::path& key);

 private:
  std::filesystem::path folder_;
  std::filesystem::path key_file_;
  bool made_ = false;
  int descriptor_ = -1;
  int key_descriptor_ = -1;
};

}  // namespace touchtrial::study
