/// \file What FFTW learned about single transforms, one file each, as text that it reads back.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace touchtrial::engine {

/// Thread-safe; processes that share a folder wait for each other while one of them measures.
class WisdomFiles {
 public:
  /// Tries a plan with this text. \return whether it fits
  using Fits = std::function<bool(const std::string& text)>;
  /// Times plans. \return what was learned
  using Learn = std::function<std::string()>;

  /// \param folder  empty: nothing is learned
  void set_folder(const std::filesystem::path& folder, std::size_t fewest_samples);

  /// The text of a transform: known, else read, else learned and kept.
  /// \param name  of the file
  /// \return nothing if the transform is too small or the text cannot be kept
  [[nodiscard]] std::optional<std::string> text_for(const std::string& name, std::size_t samples,
                                                    const Fits& fits, const Learn& learn);

 private:
  std::mutex mutex_;
  std::filesystem::path folder_;
  std::size_t fewest_samples_ = 0;
  std::map<std::string, std::optional<std::string>> known_;  // by name
};

/// The one of this process.
[[nodiscard]] WisdomFiles& wisdom_files();

/// The processor's name in letters, digits and dashes: plans of another one are of no use.
[[nodiscard]] const std::string& processor_name();

/// The text with everything but letters, digits and dots replaced by dashes.
[[nodiscard]] std::string as_file_name(const std::string& text);

}  // namespace touchtrial::engine
