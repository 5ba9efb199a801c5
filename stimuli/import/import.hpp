/// \file Imports a folder of photographs as the exemplars of a study. Manual: docs/own-images.md.
#pragma once

#include "core/errors.hpp"
#include "engine/image_file.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::stimuli {

inline constexpr int kMinCropSizePx = 16;
inline constexpr int kMaxCropSizePx = 4096;
inline constexpr int kMaxCropsOfClass = 1000;

/// The differences between pictures to remove: brightness (mean), contrast (rms).
enum class LevelEqualising { none, mean, rms, both };

struct ImportOptions {
  std::filesystem::path photographs;  ///< the folder
  std::string names;                  ///< pattern of an album's file names: {class}_#; empty: stems
  std::filesystem::path study;        ///< file to write
  std::filesystem::path pictures;     ///< folder to write; empty: default_pictures_folder
  int size_px = 500;                  ///< side of a crop, kMinCropSizePx .. kMaxCropSizePx
  int crops = 5;                      ///< per class, 1 .. kMaxCropsOfClass
  double pitch_mm = 0.2;              ///< size of a crop's pixel on the plane, 0.001 .. 10
  /// Pixels per millimetre of the photographed object. If given here or by the files, photographs
  /// are resampled to feel life-size; otherwise they are not resampled.
  std::optional<double> pixels_per_mm;
  bool pixels_per_mm_of_files = false;
  engine::SampleScale scale;  ///< of photographs of more than 8 bits
  LevelEqualising equalise = LevelEqualising::none;
  std::string protocol;    ///< name of the protocol of the study
  int methods = 1;         ///< of the study: adaptive (1), or adaptive and tv-gabor (2)
  std::string licence;     ///< of the photographs; empty: not stated
  std::string source;      ///< origin of the photographs; empty: not stated
  std::uint64_t seed = 1;  ///< determines the positions of crops
  bool replace = false;    ///< replace the outputs of an earlier import
};

/// One class of the imported study.
struct ImportedClass {
  std::string label;
  int photographs = 0;
  int crops = 0;
  bool overlapping = false;  ///< some crops overlap, at most by half their side
  double feature_mm = 0.0;   ///< median characteristic wavelength of the crops, on the plane
  double mean_grey = 0.0;    ///< over the class's crops
  double rms_grey = 0.0;     ///< mean standard deviation within a crop
};

struct ImportReport {
  std::filesystem::path study;
  std::filesystem::path pictures;
  std::vector<ImportedClass> classes;
  std::vector<std::string> ignored;   ///< files that are not pictures
  std::vector<std::string> warnings;  ///< one line each
};

/// `<study>.pictures` next to the study file.
[[nodiscard]] std::filesystem::path default_pictures_folder(const std::filesystem::path& study);

/// Called after each photograph is read, for a progress bar. Each photograph is read twice.
using ImportProgress = std::function<void(int done, int total)>;

/// Some photographs, or classes of photographs, cannot be used.
class UnusablePhotographs : public FileError {
 public:
  /// \param faults  at least one, one line each, with remedies
  /// \param remedy  for several faults together
  UnusablePhotographs(const std::filesystem::path& folder, std::vector<std::string> faults,
                      const std::string& remedy = "fix or remove the named files");

  [[nodiscard]] const std::vector<std::string>& faults() const noexcept { return faults_; }

 private:
  std::vector<std::string> faults_;
};

/// The photographs are too small or too few for the crops. The faults state numbers that would fit.
class CropsDoNotFit : public UnusablePhotographs {
 public:
  CropsDoNotFit(const std::filesystem::path& folder, std::vector<std::string> faults,
                const std::string& remedy, int crops, int size_px)
      : UnusablePhotographs(folder, std::move(faults), remedy), crops_(crops), size_px_(size_px) {}

  /// The possible number of crops of the requested size per class; 0: none.
  [[nodiscard]] int crops() const noexcept { return crops_; }
  /// The largest side for the requested number of crops; 0: even the smallest is too large.
  [[nodiscard]] int size_px() const noexcept { return size_px_; }

 private:
  int crops_;
  int size_px_;
};

/// Reads the photographs and cuts the crops like import_photographs(), without writing.
/// \param options  with numbers in range; outputs and texts are ignored
/// \throws CropsDoNotFit if photographs are too small or too few
/// \throws UnusablePhotographs, FileError as import_photographs(), for photographs
void try_photographs(const ImportOptions& options, const ImportProgress& progress = {});

/// Reads the photographs, cuts the crops, and writes pictures, manifest.json and the study file.
/// Writes nothing unless everything succeeds. The same photographs, options and seed give the same
/// crops and study. Keeps one photograph per core in memory.
/// \throws UsageError if options are out of range or contradict each other, or an output exists
/// \throws CropsDoNotFit if photographs are too small or too few
/// \throws UnusablePhotographs naming all photographs that cannot be read, equal another, are too
///   small or have an invalid name, or else all photographs with a crop of a single grey level
/// \throws FileError if the folder cannot be used, or an output cannot be written
ImportReport import_photographs(const ImportOptions& options, const ImportProgress& progress = {});

}  // namespace touchtrial::stimuli
