#include "core/outputs.hpp"

#include "core/errors.hpp"
#include "core/hash.hpp"

#include <cerrno>
#include <cstdio>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

#include <sys/xattr.h>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "user.touchtrial";

struct ForeignFilePolicy {
  std::mutex mutex;
  MovedAsideNotice notice;
};

ForeignFilePolicy& foreign_file_policy() {
  static ForeignFilePolicy policy;
  return policy;
}

MovedAsideNotice current_notice() {
  const std::lock_guard lock(foreign_file_policy().mutex);
  return foreign_file_policy().notice;
}

[[noreturn]] void refuse_path(const fs::path& path) {
  throw FileError(one_line(path.string()) +
                  ": already exists, and Touchtrial did not write it or somebody changed it "
                  "since; give another path, or --force, which keeps it as " +
                  one_line(path.filename().string()) + ".1");
}

bool is_foreign(const fs::path& path) {
  const Origin origin = origin_of(path);
  return origin == Origin::foreign || origin == Origin::unknown;
}

void move_or_refuse(const fs::path& path) {
  const MovedAsideNotice notice = current_notice();
  if (!notice) refuse_path(path);
  notice(path, move_aside(path));
}

/// Calls `replace` if the file is this program's output or has the same bytes. Otherwise moves it
/// aside and calls `write_if_free` until no other process has created a file there in between.
template <typename Replace, typename WriteIfFree>
void write_to_path(const fs::path& path, const Digest& content, const Replace& replace,
                   const WriteIfFree& write_if_free) {
  for (;;) {
    const Origin origin = origin_of(path);
    if (origin == Origin::ours) return replace();
    if (origin != Origin::nothing) {
      if (!fs::is_directory(path) && sha256_of_file(path) == content) return replace();
      move_or_refuse(path);
    }
    if (write_if_free()) return;
  }
}

}  // namespace

void move_foreign_files_aside(MovedAsideNotice notice) {
  const std::lock_guard lock(foreign_file_policy().mutex);
  foreign_file_policy().notice = std::move(notice);
}

Origin origin_of(const fs::path& file) {
  refuse_link(file);
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (!fs::exists(status)) return Origin::nothing;
  if (fs::is_directory(status)) return Origin::foreign;
  if (!fs::is_regular_file(status)) {
    throw FileError(one_line(file.string()) +
                    ": is a device or pipe, not a file; give the path of a file");
  }
  Digest mark{};
  const ssize_t size = ::getxattr(file.c_str(), kMark, mark.data(), mark.size());
  if (size < 0 && errno == ENOTSUP) return Origin::unknown;
  if (size != static_cast<ssize_t>(mark.size())) return Origin::foreign;
  return sha256_of_file(file) == mark ? Origin::ours : Origin::foreign;
}

void require_output_path(const fs::path& path) {
  if (is_foreign(path) && !current_notice()) refuse_path(path);
}

void clear_output_path(const fs::path& path) {
  if (is_foreign(path)) move_or_refuse(path);
}

fs::path move_aside(const fs::path& path) {
  for (int number = 1;; ++number) {
    // A folder's name may end in a slash.
    fs::path new_path = path.has_filename() ? path : path.parent_path();
    new_path += "." + std::to_string(number);
    if (move_to_free_name(path, new_path)) return new_path;
  }
}

void write_output(const fs::path& path, ByteView content, FileMode mode) {
  Draft draft(path, Draft::Kind::file, mode);
  const Digest mark = sha256(content);
  // If marking fails, the file merely needs --force to be replaced later.
  static_cast<void>(::fsetxattr(draft.descriptor(), kMark, mark.data(), mark.size(), 0));
  draft.write(content);
  write_to_path(
      path, mark, [&] { draft.replace(); }, [&] { return draft.rename_if_free(); });
}

void write_output(const fs::path& path, std::string_view content, FileMode mode) {
  write_output(path, bytes_of(content), mode);
}

void move_to_output(const fs::path& file, const fs::path& path) {
  const Digest mark = sha256_of_file(file);
  static_cast<void>(::setxattr(file.c_str(), kMark, mark.data(), mark.size(), 0));
  const auto replace = [&] {
    std::error_code error;
    fs::rename(file, path, error);
    if (!error) return;
    throw FileError(one_line(path.string()) + ": cannot be written (" + error.message() +
                    "); check the folder, its permissions and the free space");
  };
  write_to_path(path, mark, replace, [&] { return move_to_free_name(file, path); });
}

}  // namespace touchtrial
