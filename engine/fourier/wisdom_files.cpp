#include "engine/fourier/wisdom_files.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <cctype>
#include <fstream>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace touchtrial::engine {
namespace {

constexpr std::uintmax_t kLargestWisdom_bytes = std::uintmax_t{1} << 20U;

/// Held by one process at a time; let go when the process ends, however it ends.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : descriptor_(::open((folder / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX) != 0) {
      if (descriptor_ >= 0) ::close(descriptor_);
      throw FileError(one_line(folder.string()) + ": cannot be locked");
    }
  }
  ~FolderLock() { ::close(descriptor_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// \return nothing if the file is missing, unreadable or too large
std::optional<std::string> text_in(const std::filesystem::path& file) {
  try {
    const Bytes bytes = read_file(file, kLargestWisdom_bytes);
    return std::string(bytes.begin(), bytes.end());
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::optional<std::string> read_or_learned(const std::filesystem::path& file,
                                           const WisdomFiles::Fits& fits,
                                           const WisdomFiles::Learn& learn) {
  // Files appear whole, so nobody waits for a process that times a plan of another size.
  if (const auto text = text_in(file); text && fits(*text)) return text;
  try {
    make_folder(file.parent_path());
    const FolderLock lock(file.parent_path());
    if (const auto text = text_in(file); text && fits(*text)) return text;
    // What cannot be written is not learned: the next run would learn something else.
    replace_file(file, std::string_view());
    const std::string text = learn();
    if (!fits(text)) return std::nullopt;
    replace_file(file, text);
    return text;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

void WisdomFiles::set_folder(const std::filesystem::path& folder, std::size_t fewest_samples) {
  const std::lock_guard lock(mutex_);
  folder_ = folder;
  fewest_samples_ = fewest_samples;
  known_.clear();
}

std::optional<std::string> WisdomFiles::text_for(const std::string& name, std::size_t samples,
                                                 const Fits& fits, const Learn& learn) {
  const std::lock_guard lock(mutex_);
  if (folder_.empty() || samples < fewest_samples_) return std::nullopt;
  const auto [entry, is_new] = known_.try_emplace(name);
  if (is_new) entry->second = read_or_learned(folder_ / name, fits, learn);
  return entry->second;
}

WisdomFiles& wisdom_files() {
  static WisdomFiles files;
  return files;
}

std::string as_file_name(const std::string& text) {
  std::string name = text;
  for (char& letter : name) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '.') letter = '-';
  }
  return name;
}

const std::string& processor_name() {
  static const std::string name = [] {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
      const auto colon = line.find(": ");
      if (line.starts_with("model name") && colon != std::string::npos) {
        return as_file_name(line.substr(colon + 2));
      }
    }
    return std::string("processor");
  }();
  return name;
}

}  // namespace touchtrial::engine
