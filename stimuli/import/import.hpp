/// \file A folder of photographs made into the exemplars of a study. Manual: docs/own-images.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::stimuli {

inline constexpr int kMinCropSizePx = 16;
inline constexpr int kMaxCropSizePx = 4096;
inline constexpr int kMaxCropsOfClass = 1000;

/// Which differences in brightness (mean) and contrast (rms) between the pictures are taken away.
enum class LevelEqualising { none, mean, rms, both };

/// What the study is to ask: which texture was it, or the same with two methods.
enum class ImportProtocol { classification, comparison };

struct ImportOptions {
  std::filesystem::path photographs;  ///< the folder
  std::filesystem::path study;        ///< file to write
  std::filesystem::path pictures;     ///< folder to write; empty: default_pictures_folder
  int size_px = 500;                  ///< side of a crop, kMinCropSizePx .. kMaxCropSizePx
  int crops = 5;                      ///< of each class, 1 .. kMaxCropsOfClass
  double pitch_mm = 0.2;              ///< of a crop's pixel on the plane, 0.001 .. 10
  /// Pixels of the photographs on a millimetre of what they show; given, or as the files say, they
  /// are resampled to be felt as large as life. Otherwise pixels stay pixels.
  std::optional<double> pixels_per_mm;
  bool pixels_per_mm_of_files = false;
  LevelEqualising equalise = LevelEqualising::none;
  ImportProtocol protocol = ImportProtocol::classification;
  std::string licence;     ///< of the photographs; empty: not stated
  std::string source;      ///< where they come from; empty: not stated
  std::uint64_t seed = 1;  ///< decides where crops are cut
  bool replace = false;    ///< what an earlier import wrote may be replaced
};

/// One class of the imported study.
struct ImportedClass {
  std::string label;
  int photographs = 0;
  int crops = 0;
  bool overlapping = false;  ///< some crops share a part, at most half their side
  double feature_mm = 0.0;   ///< median characteristic wavelength of the crops, on the plane
  double mean_grey = 0.0;    ///< over the class's crops
  double rms_grey = 0.0;     ///< mean standard deviation within a crop
};

struct ImportReport {
  std::string study_name;
  std::filesystem::path study;
  std::filesystem::path pictures;
  std::vector<ImportedClass> classes;
  std::vector<std::string> ignored;   ///< files that are no pictures by their endings
  std::vector<std::string> warnings;  ///< one line each
};

/// `<study>.pictures` beside the study file.
[[nodiscard]] std::filesystem::path default_pictures_folder(const std::filesystem::path& study);

/// Told after each photograph, for a progress bar: how much is done, of how much.
using ImportProgress = std::function<void(int done, int total)>;

/// Reads the photographs, cuts the crops, and writes pictures, manifest.json and the study file.
/// Nothing is written unless everything succeeds. The same photographs, options and seed give the
/// same crops and study. Memory: one photograph at a time.
/// \throws UsageError if options are out of range or do not go together, or an output is there
///   already
/// \throws FileError if the folder or a photograph cannot be used (too few, too small, twice the
///   same, unreadable, of a label that cannot be), or an output cannot be written
ImportReport import_photographs(const ImportOptions& options, const ImportProgress& progress = {});

}  // namespace touchtrial::stimuli
