#include "study/pack_lock.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <cerrno>
#include <iterator>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace touchtrial::study {
namespace {

/// Whether the open file still has this name: the process that created the folder may have removed
/// it.
bool has_name(int descriptor, const std::filesystem::path& file) {
  struct stat open {};
  struct stat named {};
  return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

/// \return the error, or 0
int lock(int descriptor, int operation) {
  while (::flock(descriptor, operation) != 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

[[noreturn]] void refuse(const std::filesystem::path& what, int reason) {
  const std::string place = one_line(what.string());
  if (reason == EWOULDBLOCK) {
    throw FileError(place +
                    ": is in use by another process, which prepares it or runs a session; wait "
                    "until that process ends");
  }
  throw FileError(place + ": cannot be locked (" + std::generic_category().message(reason) +
                  "); check the folder's permissions and the free disk space");
}

/// \param what  path named in the error message
/// \param ensure_folder  called before each attempt, because another process may have removed
///   the folder
/// \return the descriptor of the file that holds the lock
template <typename MakeFolder>
int open_locked(const std::filesystem::path& file, const std::filesystem::path& what, int operation,
                MakeFolder ensure_folder) {
  // Other processes that found nothing to do may remove the folder, each of them once.
  constexpr int kMaxAttempts = 100;
  for (int attempt = 0;; ++attempt) {
    ensure_folder();
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    const int reason = descriptor < 0 ? errno : lock(descriptor, operation);
    if (reason == 0 && has_name(descriptor, file)) return descriptor;
    if (descriptor >= 0) ::close(descriptor);
    const bool is_gone = reason == ENOENT && attempt < kMaxAttempts;
    if (reason != 0 && !is_gone) refuse(what, reason);
  }
}

}  // namespace

PackLock::PackLock(std::filesystem::path folder, Use use, Wait wait) : folder_(std::move(folder)) {
  const std::filesystem::path file = folder_ / "prepare.lock";
  const int waiting = wait == Wait::yes ? 0 : LOCK_NB;
  if (use == Use::prepare) {
    descriptor_ = open_locked(file, folder_, LOCK_EX | waiting, [this] {
      created_folder_ = created_folder_ || !path_exists(folder_);
      make_folder(folder_);
    });
    return;
  }
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor_ < 0) return;
  const int reason = lock(descriptor_, LOCK_SH | waiting);
  if (reason == 0) return;
  ::close(descriptor_);
  refuse(folder_, reason);
}

PackLock::~PackLock() {
  std::error_code ignored;
  if (key_descriptor_ >= 0) {
    std::filesystem::remove(key_file_, ignored);
    ::close(key_descriptor_);
  }
  if (created_folder_) {
    const auto files = std::filesystem::directory_iterator(folder_, ignored);
    if (std::distance(begin(files), end(files)) == 1) {
      std::filesystem::remove(folder_ / "prepare.lock", ignored);
      std::filesystem::remove(folder_, ignored);
    }
  }
  if (descriptor_ >= 0) ::close(descriptor_);
}

void PackLock::lock_key(const std::filesystem::path& key) {
  key_file_ = key;
  key_file_ += ".lock";
  key_descriptor_ = open_locked(key_file_, key, LOCK_EX | LOCK_NB, [] {});
}

}  // namespace touchtrial::study
