/// \file Builds the pack of a study, but only those fields that are missing or out of date.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/pack/pack.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"
#include "study/pack_lock.hpp"
#include "study/study_key.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::study {

/// The paths of a study's pack and key.
struct PackPlace {
  std::filesystem::path pack;
  std::filesystem::path key;

  /// `<study>.station` beside the key, or `<study>.NAME.station` for one of several stations.
  /// \param name  the station's name; empty or kOnlyStation: the study's only station
  [[nodiscard]] std::filesystem::path station(const std::string& name = {}) const;
};

/// `<study>.pack` and `<study>.key` beside the study file.
[[nodiscard]] PackPlace default_pack_place(const std::filesystem::path& study_file);
/// `<study>.sim.pack` beside the study file; the key's path is empty, because each simulated
/// database has its own copy of the key.
[[nodiscard]] PackPlace simulated_pack_place(const std::filesystem::path& study_file);
/// Takes this folder as the pack, and the same path with `.key` instead of `.pack` as the key.
[[nodiscard]] PackPlace pack_place_at(const std::filesystem::path& pack_folder);

/// Finds a key's pack: the folder that the key names or, if it does not exist because the key was
/// moved, a folder of the same name that contains this study's pack, beside the database, beside
/// the study file or in the current folder.
/// \return the folder that the key names if no pack is found; empty if the key names none
[[nodiscard]] std::filesystem::path find_pack(const StudyCodes& codes,
                                              const std::filesystem::path& database);

/// The preparation of one stimulus. Shown to the person who prepares a study, never during
/// sessions.
struct PreparedStimulus {
  std::string class_label;
  int exemplar = 0;
  std::string method;  ///< label of the method
  bool reused = false;
  engine::FieldStatistics statistics;  ///< zeros if they were not requested
  engine::Gains gains;
  double seconds = 0.0;
  std::uintmax_t bytes = 0;
};

/// Work that was skipped, and the reason.
struct SkippedWork {
  std::string what;
  std::string why;
  std::uintmax_t bytes = 0;  ///< disk space saved
};

struct PrepareReport {
  std::vector<PreparedStimulus> stimuli;   ///< of StudyCodes::stimuli
  std::vector<PreparedStimulus> practice;  ///< of StudyCodes::practice
  std::vector<SkippedWork> skipped;
  std::vector<std::string> warnings;
};

inline constexpr std::int64_t kLargeImagePixels = std::int64_t{1} << 22;

/// Computes the gains of a study that states a level, which depend on devices and hands, and
/// warnings for the person who prepares the study.
/// \param fields  of StudyCodes::stimuli
using LevelGains = std::function<std::pair<engine::StudyGains, std::vector<std::string>>(
    std::span<const engine::FieldView> fields)>;

/// Options of prepare_pack.
struct PrepareOptions {
  bool statistics = true;  ///< whether to compute statistics, with two Fourier transforms per field
  std::int64_t large_image_px =
      kLargeImagePixels;     ///< images above this size are processed one at a time
  LevelGains level_gains{};  ///< needed if the study has a level
  /// Moves the key and station files into their places. Called when everything is built, before the
  /// pack's files change; may throw.
  std::function<void()> publish_secrets{};
  /// Whether the key is not saved yet; drafts of a failed run are then useless, and are removed.
  bool is_new_key = false;
};

/// Checks that all images of the study, its instructions and its practice exist. Call before
/// anything is written.
/// \throws StudyError with the place in the study file of the first missing image
void check_images_exist(const Study& study);

/// The plane of a study, which has the size of each picture. Reads only headers of pictures.
/// \throws StudyError with the place in the study file and the remedy, if a picture cannot be read
///   or differs in size, or if a practice picture is smaller
[[nodiscard]] PlaneGeometry plane_of(const Study& study);

/// Called after each stimulus, from any thread, but never concurrently.
using Progress = std::function<void(int done, int total)>;

/// Builds a pack. It extracts, renders and writes every field of the key that is missing, damaged
/// or made from different input. Then it chooses the gains (for practice: practice_gains), signs
/// the manifest with the digests of the pictures that participants see, moves everything into the
/// pack, and removes fields that no stimulus uses any more. Fields that the key did not sign are
/// rebuilt, with a warning.
///
/// A run that fails leaves the pack unchanged. If a picture is at fault, or the process is killed,
/// the next run reuses the finished fields. A run that is killed while it moves them leaves a pack
/// that sessions refuse and the next run completes. If nothing has changed, no file is written.
/// Changes of pictures and fields are detected by content, not by time.
///
/// The pack's bytes depend only on key, study and images, not on the number of threads. Images of
/// more than PrepareOptions::large_image_px pixels are processed one after another, so that the
/// memory for a large image (docs/benchmarks/README.md) is needed only once.
/// \param lock  lock of the pack's folder, for Use::prepare
/// \throws StudyError if an image cannot be read, with its place in the study
/// \throws FileError if the pack cannot be written, or belongs to another key
PrepareReport prepare_pack(const PackLock& lock, const StudyKey& key, const Progress& progress = {},
                           const PrepareOptions& options = {});

/// Overload that locks the folder itself.
/// \throws FileError also if another process prepares or reads the pack
PrepareReport prepare_pack(const StudyKey& key, const std::filesystem::path& pack_folder,
                           const Progress& progress = {}, const PrepareOptions& options = {});

}  // namespace touchtrial::study
