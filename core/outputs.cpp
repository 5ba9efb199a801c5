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

struct FilesInTheWay {
  std::mutex mutex;
  MovedAsideNotice notice;
};

FilesInTheWay& files_in_the_way() {
  static FilesInTheWay files;
  return files;
}

MovedAsideNotice current_notice() {
  const std::lock_guard lock(files_in_the_way().mutex);
  return files_in_the_way().notice;
}

[[noreturn]] void refuse_place(const fs::path& place) {
  throw FileError(one_line(place.string()) +
                  ": is there already, and Touchtrial did not write it or somebody changed it "
                  "since; give another place, or --force, which keeps it as " +
                  one_line(place.filename().string()) + ".1");
}

bool is_in_the_way(const fs::path& place) {
  const Origin origin = origin_of(place);
  return origin == Origin::others || origin == Origin::unknown;
}

void move_out_of_the_way(const fs::path& place) {
  const MovedAsideNotice notice = current_notice();
  if (!notice) refuse_place(place);
  notice(place, move_aside(place));
}

/// Calls `replace` for our own output or a file with the same bytes. Otherwise makes way and calls
/// `take_free`, again if another process creates a file there in between.
template <typename Replace, typename TakeFree>
void take_place(const fs::path& place, const Digest& content, const Replace& replace,
                const TakeFree& take_free) {
  for (;;) {
    const Origin origin = origin_of(place);
    if (origin == Origin::ours) return replace();
    if (origin != Origin::nothing) {
      if (!fs::is_directory(place) && sha256_of_file(place) == content) return replace();
      move_out_of_the_way(place);
    }
    if (take_free()) return;
  }
}

}  // namespace

void move_foreign_files_aside(MovedAsideNotice notice) {
  const std::lock_guard lock(files_in_the_way().mutex);
  files_in_the_way().notice = std::move(notice);
}

Origin origin_of(const fs::path& file) {
  refuse_link(file);
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (!fs::exists(status)) return Origin::nothing;
  if (fs::is_directory(status)) return Origin::others;
  if (!fs::is_regular_file(status)) {
    throw FileError(one_line(file.string()) +
                    ": is a device or pipe, not a file; give the path of a file");
  }
  Digest mark{};
  const ssize_t size = ::getxattr(file.c_str(), kMark, mark.data(), mark.size());
  if (size < 0 && errno == ENOTSUP) return Origin::unknown;
  if (size != static_cast<ssize_t>(mark.size())) return Origin::others;
  return sha256_of_file(file) == mark ? Origin::ours : Origin::others;
}

void require_output_place(const fs::path& place) {
  if (is_in_the_way(place) && !current_notice()) refuse_place(place);
}

void clear_output_place(const fs::path& place) {
  if (is_in_the_way(place)) move_out_of_the_way(place);
}

fs::path move_aside(const fs::path& place) {
  for (int number = 1;; ++number) {
    // A folder's name may end in a slash.
    fs::path kept = place.has_filename() ? place : place.parent_path();
    kept += "." + std::to_string(number);
    if (move_to_free_name(place, kept)) return kept;
  }
}

void write_output(const fs::path& place, ByteView content, FileMode mode) {
  Draft draft(place, Draft::Kind::file, mode);
  const Digest mark = sha256(content);
  // If marking fails, the file merely needs --force to be replaced later.
  static_cast<void>(::fsetxattr(draft.descriptor(), kMark, mark.data(), mark.size(), 0));
  draft.write(content);
  take_place(
      place, mark, [&] { draft.replace(); }, [&] { return draft.rename_if_free(); });
}

void write_output(const fs::path& place, std::string_view content, FileMode mode) {
  write_output(place, bytes_of(content), mode);
}

void move_to_output(const fs::path& made, const fs::path& place) {
  const Digest mark = sha256_of_file(made);
  static_cast<void>(::setxattr(made.c_str(), kMark, mark.data(), mark.size(), 0));
  const auto replace = [&] {
    std::error_code error;
    fs::rename(made, place, error);
    if (!error) return;
    throw FileError(one_line(place.string()) + ": cannot be written (" + error.message() +
                    "); check the folder, its permissions and the free space");
  };
  take_place(place, mark, replace, [&] { return move_to_free_name(made, place); });
}

}  // namespace touchtrial
