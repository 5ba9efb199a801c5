/// \file One program at a time in one participant's session.
#pragma once

#include <filesystem>
#include <string>

namespace touchtrial::store {

/// Holds a participant of a study until it goes. The kernel releases it with the process, however
/// that ends. It is on `<db>.lock`, an empty file that stays; other participants are not hindered.
/// Advisory: it keeps this program's sessions apart and nothing else. Folders that several machines
/// share may not know such locks.
class SessionLock {
 public:
  /// Takes it without waiting.
  /// \throws StoreError, naming the participant and what to do, if another holds it, or if the file
  ///   cannot be made
  SessionLock(const std::filesystem::path& database, const std::string& participant);
  ~SessionLock();
  SessionLock(SessionLock&& other) noexcept;
  SessionLock& operator=(SessionLock&&) = delete;

 private:
  int file_ = -1;
};

}  // namespace touchtrial::store
