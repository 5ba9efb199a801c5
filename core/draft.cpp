#include "core/draft.hpp"

#include "core/errors.hpp"
#include "core/text.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBegin = ".touchtrial-";
constexpr std::string_view kEnd = ".tmp";
constexpr int kReadFlags = O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;

[[noreturn]] void refuse_draft(const fs::path& final_path, int error) {
  throw FileError(one_line(final_path.string()) + ": cannot be written (" +
                  std::generic_category().message(error) +
                  "); check the folder, its permissions and the free space");
}

fs::path folder_of(const fs::path& final_path) {
  return final_path.has_parent_path() ? final_path.parent_path() : fs::path(".");
}

fs::path new_draft_path(const fs::path& final_path) {
  static std::atomic<unsigned> count{0};
  return final_path.parent_path() / (std::string(kBegin) + std::to_string(::getpid()) + "-" +
                                     std::to_string(count++) + std::string(kEnd));
}

/// Whether the name is ".touchtrial-PROCESS-NUMBER.tmp".
bool is_draft_name(std::string_view name) {
  if (!name.starts_with(kBegin) || !name.ends_with(kEnd)) return false;
  if (name.size() <= kBegin.size() + kEnd.size()) return false;
  name = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
  const std::size_t dash = name.find('-');
  return dash != std::string_view::npos && number_in<unsigned>(name.substr(0, dash)) &&
         number_in<unsigned>(name.substr(dash + 1));
}

/// \return false if another program has the lock; also true on file systems without locks
bool lock(int descriptor) {
  return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

/// Removes this user's draft if its process has ended.
void remove_if_stale(const fs::path& draft) {
  const int descriptor = ::open(draft.c_str(), kReadFlags);
  if (descriptor < 0) return;
  struct stat status {};
  const bool is_ours = ::fstat(descriptor, &status) == 0 && status.st_uid == ::geteuid();
  if (is_ours && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
    std::error_code ignored;  // a leftover draft does no harm
    fs::remove_all(draft, ignored);
  }
  ::close(descriptor);
}

/// Does nothing for a folder that this process has cleaned before.
void remove_stale_drafts(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> cleaned_folders;
  std::error_code ignored;
  const std::lock_guard guard(mutex);
  if (!cleaned_folders.insert(fs::absolute(folder, ignored)).second) return;
  std::vector<fs::path> drafts;
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    if (is_draft_name(entry->path().filename().string())) drafts.push_back(entry->path());
  }
  for (const fs::path& draft : drafts) remove_if_stale(draft);
}

}  // namespace

void refuse_link(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(path, error))) return;
  const fs::path target = fs::read_symlink(path, error);
  throw FileError(one_line(path.string() + ": is a link to " + target.string() +
                           ", and nothing is written through a link; give the path of the file "
                           "itself, or remove the link"));
}

void sync_folder(const fs::path& folder) noexcept {
  const int descriptor =
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

Draft::Draft(fs::path final_path, Kind kind, FileMode mode) : final_path_(std::move(final_path)) {
  remove_stale_drafts(folder_of(final_path_));
  while (!make(kind, mode)) {
  }
}

/// \return false if the name exists already, or another process removed the draft as stale
bool Draft::make(Kind kind, FileMode mode) {
  path_ = new_draft_path(final_path_);
  if (kind == Kind::folder) {
    if (::mkdir(path_.c_str(), 0777) != 0) {
      if (errno == EEXIST) return false;
      refuse_draft(final_path_, errno);
    }
    descriptor_ = ::open(path_.c_str(), kReadFlags | O_DIRECTORY);
  } else {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                         mode == FileMode::owner_only ? 0600 : 0644);
  }
  if (descriptor_ < 0) {
    const int error = errno;
    if (error == EEXIST || (error == ENOENT && kind == Kind::folder)) return false;
    std::error_code ignored;
    if (kind == Kind::folder) fs::remove(path_, ignored);
    refuse_draft(final_path_, error);
  }
  struct stat status {};
  if (lock(descriptor_) && ::fstat(descriptor_, &status) == 0 && status.st_nlink > 0) return true;
  ::close(std::exchange(descriptor_, -1));
  return false;
}

Draft::~Draft() {
  std::error_code ignored;
  // Unlike remove_all, unlink needs no memory.
  if (!path_.empty() && ::unlink(path_.c_str()) != 0) fs::remove_all(path_, ignored);
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Draft::write(ByteView content) const {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor_, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse_draft(final_path_, errno);
    content = content.subspan(static_cast<std::size_t>(written));
  }
  if (::fsync(descriptor_) != 0) refuse_draft(final_path_, errno);
}

void Draft::replace() {
  if (std::rename(path_.c_str(), final_path_.c_str()) != 0) refuse_draft(final_path_, errno);
  path_.clear();
  sync_folder(final_path_.parent_path());
}

bool Draft::rename_if_free() {
  if (!move_to_free_name(path_, final_path_)) return false;
  path_.clear();
  return true;
}

}  // namespace touchtrial
