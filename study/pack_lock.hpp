/// \file The lock of a pack's folder: one process writes the pack, or any number of them read it.
#pragma once

#include <filesystem>

namespace touchtrial::study {

/// A lock on `prepare.lock` in the pack's folder. The system releases it when the process ends.
class PackLock {
 public:
  enum class Use { prepare, read };
  enum class Wait { no, yes };

  /// For Use::prepare, creates the folder if it is missing. For Use::read, creates nothing, and
  /// locks nothing if there is no `prepare.lock`, because the pack was then never prepared.
  /// \param wait  whether to wait for other processes and threads
  /// \throws FileError if another one holds the lock and `wait` is no, or if the file cannot be
  ///   created
  explicit PackLock(std::filesystem::path folder, Use use = Use::prepare, Wait wait = Wait::no);
  /// Releases all locks. Removes the folder if this lock created it and it is still empty.
  ~PackLock();
  PackLock(const PackLock&) = delete;
  PackLock& operator=(const PackLock&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// Also locks a key, which two packs may share, with `<key>.lock` beside it.
  /// \throws FileError if another process holds that lock, or if the file cannot be created
  void lock_key(const std::filesystem::path& key);

 private:
  std::filesystem::path folder_;
  std::filesystem::path key_file_;
  bool created_folder_ = false;
  int descriptor_ = -1;
  int key_descriptor_ = -1;
};

}  // namespace touchtrial::study
