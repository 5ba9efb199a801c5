/// \file Keeps a second program out of a participant's session.
#pragma once

#include <filesystem>
#include <string>

namespace touchtrial::record {

/// Holds a lock on one participant of a study while it exists. The kernel releases the lock when
/// the process ends, in whatever way. The lock is on `<db>.lock`, an empty file that stays, and
/// does not hinder sessions of other participants. It is advisory: it keeps only this program's
/// sessions apart. Folders that several machines share may not support such locks.
class SessionLock {
 public:
  /// Takes the lock without waiting.
  /// \throws StoreError, naming the participant and what to do, if another holds it, or if the file
  ///   cannot be made
  SessionLock(const std::filesystem::path& database, const std::string& participant);
  ~SessionLock();
  SessionLock(SessionLock&& other) noexcept;
  SessionLock& operator=(SessionLock&&) = delete;

 private:
  int file_ = -1;
};

}  // namespace touchtrial::record
