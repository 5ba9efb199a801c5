/// \file How Fourier transforms are planned: by FFTW's estimate, or by measurements whose results
/// are kept in files. Source: docs/decisions/0012-measured-transforms.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace touchtrial::engine {

/// To measure plans takes about as long as a hundred transforms. It pays from this size on.
inline constexpr std::size_t kSamplesWorthMeasuring = std::size_t{1} << 18U;

/// From now on, transforms of at least `fewest_samples` follow the plan that a file in the folder
/// holds. If no file fits, plans are measured and the result is kept, so that every later run on
/// the machine uses the same plan and gives the same bits. If the result cannot be kept, the plan
/// is estimated; that is no error.
/// \param folder  created if it is missing. If it is empty, as at the start of the program, every
///   plan is estimated: the same in every process with the same FFTW and processor.
/// Affects the whole process. Thread-safe. Existing transforms keep their plans.
void use_measured_plans(const std::filesystem::path& folder,
                        std::size_t fewest_samples = kSamplesWorthMeasuring);

/// The user's cache folder for this program: touchtrial in $XDG_CACHE_HOME, else in ~/.cache. Empty
/// if neither variable holds an absolute path.
[[nodiscard]] std::filesystem::path user_cache_folder();

/// FFTW's measurements ("wisdom"), one file for each transform, as text that FFTW reads back.
/// Thread-safe. Processes that share a folder wait for one another while one of them measures.
class WisdomFiles {
 public:
  /// Tries to plan with this text.
  /// \return whether it fits
  using Fits = std::function<bool(const std::string& text)>;
  /// Measures plans.
  /// \return FFTW's wisdom
  using Learn = std::function<std::string()>;

  /// \param folder  empty: nothing is measured
  void set_folder(const std::filesystem::path& folder, std::size_t fewest_samples);

  /// The text for a transform: from memory, else from its file, else measured and kept.
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

/// The files of this process.
[[nodiscard]] WisdomFiles& wisdom_files();

/// The processor's name in letters, digits and dashes. Plans for another processor are useless.
[[nodiscard]] const std::string& processor_name();

/// The text with everything but letters, digits and dots replaced by dashes.
[[nodiscard]] std::string as_file_name(const std::string& text);

}  // namespace touchtrial::engine
