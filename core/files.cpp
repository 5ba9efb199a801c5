#include "core/files.hpp"

#include "core/draft.hpp"
#include "core/errors.hpp"

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace touchtrial {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& fault, int error,
                       const std::string& remedy) {
  throw FileError(one_line(path.string()) + ": " + fault + " (" +
                  std::generic_category().message(error) + "); " + remedy);
}

/// Closes a descriptor at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) noexcept : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

/// Renames on a file system without an exclusive rename: claims the new name with an empty file or
/// folder first.
/// \return 0, or -1 with errno
int claim_and_rename(const std::filesystem::path& file, const std::filesystem::path& name) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    if (::mkdir(name.c_str(), 0700) != 0) return -1;
  } else {
    const Descriptor claim(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    if (claim.number() < 0) return -1;
  }
  if (std::rename(file.c_str(), name.c_str()) == 0) return 0;
  const int error = errno;
  std::filesystem::remove(name, ignored);
  errno = error;
  return -1;
}

}  // namespace

Bytes read_file(const std::filesystem::path& path, std::uintmax_t limit_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw FileError(one_line(path.string()) + ": does not exist; check the path");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw FileError(one_line(path.string()) + ": is not a file; give the path of a file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) fail(path, "cannot be read", error.value(), "check its permissions");
  if (size > limit_bytes) {
    throw FileError(one_line(path.string()) + ": has " + std::to_string(size) +
                    " bytes, more than " + std::to_string(limit_bytes) + "; give a smaller file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "cannot be read", errno, "check its permissions");
  Bytes content(static_cast<std::size_t>(size));
  file.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(size));
  content.resize(static_cast<std::size_t>(file.gcount()));
  return content;
}

void replace_file(const std::filesystem::path& path, ByteView content, FileMode mode) {
  refuse_link(path);
  std::error_code error;
  const auto status = std::filesystem::symlink_status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw FileError(one_line(path.string()) +
                    ": is a folder, device or pipe, not a file; give the path of a file");
  }
  Draft draft(path, Draft::Kind::file, mode);
  draft.write(content);
  draft.replace();
}

void replace_file(const std::filesystem::path& path, std::string_view content, FileMode mode) {
  replace_file(path, bytes_of(content), mode);
}

void rename_file(const std::filesystem::path& file, const std::filesystem::path& name) {
  if (std::rename(file.c_str(), name.c_str()) != 0) {
    fail(name, "cannot be written", errno, "check the folder and its permissions");
  }
  sync_folder(name.parent_path());
}

bool move_to_free_name(const std::filesystem::path& file, const std::filesystem::path& name) {
  int result = ::renameat2(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), RENAME_NOREPLACE);
  if (result != 0 && (errno == EINVAL || errno == ENOSYS)) result = claim_and_rename(file, name);
  if (result != 0 && errno == EEXIST) return false;
  if (result != 0) {
    fail(name, "cannot be made", errno, "check the folder, its permissions and the free space");
  }
  sync_folder(name.parent_path());
  return true;
}

void require_owner_only(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    fail(path, "cannot be read", errno, "check that it exists and its permissions");
  }
  if ((status.st_mode & 077U) == 0) return;
  throw FileError(one_line(path.string() +
                           ": others may read this file of secrets; run `chmod 600 " +
                           path.string() + "`, and ask who has read it"));
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return;
  const std::string reason = error ? error.message() : "a file of that name exists";
  throw FileError(one_line(folder.string()) + ": cannot be created as a folder (" + reason +
                  "); give another path, or change the permissions");
}

bool path_exists(const std::filesystem::path& path) noexcept {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

MappedFile::MappedFile(const std::filesystem::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0)
    fail(path, "cannot be opened", errno, "check that it exists and its permissions");
  struct stat status {};
  if (::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_size <= 0) {
    throw FileError(one_line(path.string()) + ": is empty or not a file; create it again");
  }
  size_ = static_cast<std::size_t>(status.st_size);
  void* mapping = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.number(), 0);
  if (mapping == MAP_FAILED) fail(path, "cannot be mapped", errno, "check the free memory");
  data_ = static_cast<const std::uint8_t*>(mapping);
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<std::uint8_t*>(data_), size_);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

std::filesystem::path database_companion(const std::filesystem::path& database,
                                         const char* suffix) {
  std::error_code error;
  const bool is_link = std::filesystem::is_symlink(database, error);
  std::filesystem::path path = is_link ? std::filesystem::weakly_canonical(database) : database;
  path += suffix;
  return path;
}

}  // namespace touchtrial
