#include "core/file_stamp.hpp"

#include <algorithm>

#include <sys/stat.h>

namespace touchtrial {
namespace {

std::int64_t nanoseconds(const timespec& time) noexcept {
  return std::int64_t{time.tv_sec} * std::int64_t{1'000'000'000} + time.tv_nsec;
}

}  // namespace

std::optional<FileStamp> stamp_of(const std::filesystem::path& file) {
  const std::chrono::nanoseconds now = std::chrono::system_clock::now().time_since_epoch();
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return FileStamp{static_cast<std::uint64_t>(status.st_size), status.st_ino,
                   nanoseconds(status.st_mtim), nanoseconds(status.st_ctim), now.count()};
}

bool is_unchanged(const FileStamp& before, const FileStamp& now,
                  std::chrono::nanoseconds settled_after) noexcept {
  const bool same = before.bytes == now.bytes && before.inode == now.inode &&
                    before.modified_ns == now.modified_ns && before.changed_ns == now.changed_ns;
  return same &&
         std::max(before.modified_ns, before.changed_ns) + settled_after.count() <= before.taken_ns;
}

}  // namespace touchtrial
