/// \file Prevents two programs from running a participant's session at once.
#pragma once

#include <filesystem>
#include <string>

namespace touchtrial::record {

/// Holds a lock on one participant of a study while it exists. The kernel releases the lock when
/// the process ends in any way. The lock is on `<db>.lock`, an empty file that remains, and does
/// not block sessions of other participants. It is advisory: only this program respects it. Network
/// folders may not support such locks.
class SessionLock {
 public:
  /// Acquires the lock without waiting.
  /// \throws StoreError, naming the participant and what to do, if another program holds it, or the
  ///   file cannot be created
  SessionLock(const std::filesystem::path& database, const std::string& participant);
  ~SessionLock();
  SessionLock(SessionLock&& other) noexcept;
  SessionLock& operator=(SessionLock&&) = delete;

 private:
  int file_ = -1;
};

}  // namespace touchtrial::record
