#include "engine/fourier/planning.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <cctype>
#include <cstdlib>
#include <fstream>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace touchtrial::engine {
namespace {

constexpr std::uintmax_t kLargestWisdom_bytes = std::uintmax_t{1} << 20U;

/// A lock that one process holds at a time. The system releases it however the process ends.
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
    return text_of(read_file(file, kLargestWisdom_bytes));
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::optional<std::string> read_or_measured(const std::filesystem::path& file,
                                            const WisdomFiles::Fits& fits,
                                            const WisdomFiles::Learn& learn) {
  // Files appear complete, so no process waits while another measures a plan of another size.
  if (const auto text = text_in(file); text && fits(*text)) return text;
  try {
    make_folder(file.parent_path());
    const FolderLock lock(file.parent_path());
    if (const auto text = text_in(file); text && fits(*text)) return text;
    // If the file cannot be written, nothing is measured: the next run would get another plan.
    replace_file(file, std::string_view());
    const std::string text = learn();
    if (!fits(text)) return std::nullopt;
    replace_file(file, text);
    return text;
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// \return the variable's value if it is an absolute path, else an empty path
std::filesystem::path absolute_path_in(const char* variable) {
  const char* value = std::getenv(variable);
  const std::filesystem::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? path : std::filesystem::path();
}

}  // namespace

void use_measured_plans(const std::filesystem::path& folder, std::size_t fewest_samples) {
  wisdom_files().set_folder(folder, fewest_samples);
}

std::filesystem::path user_cache_folder() {
  if (const auto cache = absolute_path_in("XDG_CACHE_HOME"); !cache.empty()) {
    return cache / "touchtrial";
  }
  const auto home = absolute_path_in("HOME");
  return home.empty() ? home : home / ".cache" / "touchtrial";
}

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
  if (is_new) entry->second = read_or_measured(folder_ / name, fits, learn);
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
