#include "protocols/design/pack_lock.hpp"

#include "core/errors.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace touchtrial::design {

PackLock::PackLock(const std::filesystem::path& folder, bool wait)
    : descriptor_(::open((folder / "prepare.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_ >= 0 && ::flock(descriptor_, wait ? LOCK_EX : LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  if (descriptor_ >= 0) ::close(descriptor_);
  const std::string place = one_line(folder.string());
  if (reason == EWOULDBLOCK) {
    throw FileError(place + ": the pack is being prepared by another process; wait for it to end");
  }
  throw FileError(place + ": the pack cannot be locked (" +
                  std::generic_category().message(reason) +
                  "); check the folder's permissions and the free space");
}

PackLock::~PackLock() {
  ::close(descriptor_);
}

}  // namespace touchtrial::design
