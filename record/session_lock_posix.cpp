#include "core/bytes.hpp"
#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/hash.hpp"
#include "record/session_lock.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace touchtrial::record {
namespace {

/// The offset of the participant's byte, which may be beyond the end of the file.
off_t lock_offset(const std::string& participant) {
  const Digest digest = sha256(bytes_of(participant));
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < 7; ++i) number = (number << 8U) | digest.at(i);
  return static_cast<off_t>(number);
}

/// \return false, with errno, if the lock was not acquired
bool lock_participant(int file, const std::string& participant) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = lock_offset(participant);
  lock.l_len = 1;
  // The lock belongs to this open file, so that two sessions of one process exclude each other too.
  return ::fcntl(file, F_OFD_SETLK, &lock) == 0;
}

[[noreturn]] void refuse_lock(const std::filesystem::path& path, const std::string& reason) {
  throw StoreError(one_line(path.string() + ": " + reason));
}

}  // namespace

SessionLock::SessionLock(const std::filesystem::path& database, const std::string& participant) {
  const std::filesystem::path path = database_companion(database, ".lock");
  refuse_link(path);
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file_ < 0) {
    refuse_lock(path, std::string("cannot be created (") + std::strerror(errno) +
                          "); check that its folder is writable");
  }
  if (lock_participant(file_, participant)) return;
  const int error = errno;
  ::close(std::exchange(file_, -1));
  if (error != EAGAIN && error != EACCES) {
    refuse_lock(path, std::string("cannot be locked (") + std::strerror(error) +
                          "); move the database to a local disk");
  }
  refuse_lock(database,
              "participant " + participant +
                  " is in a session of another program; continue in that window, or end it there "
                  "and start again");
}

SessionLock::SessionLock(SessionLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

SessionLock::~SessionLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace touchtrial::record
