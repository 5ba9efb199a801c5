/// \file Builds the pack of a study. Only fields that are missing or out of date are built.
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
  /// \param name  of the station; empty or kOnlyStation: the study's only one
  [[nodiscard]] std::filesystem::path station(const std::string& name = {}) const;
};

/// `<study>.pack` and `<study>.key` beside the study file.
[[nodiscard]] PackPlace default_pack_place(const std::filesystem::path& study_file);
/// `<study>.sim.pack` beside the study file; the key's path is empty, because each simulated
/// database has its own copy of the key.
[[nodiscard]] PackPlace simulated_pack_place(const std::filesystem::path& study_file);
/// The given folder as the pack, and the same path with `.key` in place of `.pack` as the key.
[[nodiscard]] PackPlace pack_place_at(const std::filesystem::path& pack_folder);

/// Where a key's pack is: in the folder that the key names or, if that is gone (a key on another
/// medium names its pack from there), in one of the same name with this study's pack: beside the
/// database, beside the study file, or in the current folder.
/// \return the folder that the key names if there is none; empty if it names none
[[nodiscard]] std::filesystem::path pack_in_reach(const StudyCodes& codes,
                                                  const std::filesystem::path& database);

/// How one stimulus was prepared. Shown to those who prepare a study, never during the study.
struct PreparedStimulus {
  std::string class_label;
  int exemplar = 0;
  std::string method;  ///< label of the method
  bool reused = false;
  engine::FieldStatistics statistics;  ///< zeros if not requested
  engine::Gains gains;
  double seconds = 0.0;
  std::uintmax_t bytes = 0;
};

/// Work that was skipped, and the reason.
struct SkippedWork {
  std::string what;
  std::string why;
  std::uintmax_t bytes = 0;  ///< bytes that were not written
};

struct PrepareReport {
  std::vector<PreparedStimulus> stimuli;   ///< of StudyCodes::stimuli
  std::vector<PreparedStimulus> practice;  ///< of StudyCodes::practice
  std::vector<SkippedWork> skipped;
  std::vector<std::string> warnings;
};

inline constexpr std::int64_t kLargeImagePixels = std::int64_t{1} << 22;

/// The gains of a study that states its level, which depend on devices and hands, and what the
/// person who prepares the study must be told.
/// \param fields  of StudyCodes::stimuli
using LevelGains = std::function<std::pair<engine::StudyGains, std::vector<std::string>>(
    std::span<const engine::FieldView> fields)>;

/// What prepare_pack does besides building the pack.
struct PrepareOptions {
  bool statistics = true;  ///< fill in PreparedStimulus::statistics; two Fourier transforms each
  std::int64_t large_image_px = kLargeImagePixels;  ///< larger images are processed one at a time
  LevelGains level_gains{};                         ///< needed if the study has a level
  /// Puts key and stations' files into their places. Called when everything is built, before the
  /// pack's files change; may throw.
  std::function<void()> publish_secrets{};
  /// Whether no file has the key yet: if the preparation fails, its drafts are of no use.
  bool is_new_key = false;
};

/// Checks that every image of the study exists, every picture of its instructions, and every
/// practice image if there is practice. Call before anything is written.
/// \throws StudyError with the place in the study file of the first missing image
void check_images_exist(const Study& study);

/// The plane of a study: as large as each of its pictures. Reads their headers (size_of_image).
/// \throws StudyError, with its place in the study file and the remedy, for the first picture that
///   cannot be read or has another size, and for a practice picture that is smaller
[[nodiscard]] PlaneGeometry plane_of(const Study& study);

/// Called after each stimulus, from any thread, but never by two threads at the same time.
using Progress = std::function<void(int done, int of)>;

/// Extracts, renders and writes every field of the key that is missing, damaged or made from
/// different input. Then chooses the gains (of practice: practice_gains), signs the table of
/// contents with the digests of the pictures that participants see, puts everything into its place,
/// and removes fields that no stimulus uses any more. What the key did not sign is built anew, with
/// a warning.
/// A run that fails leaves the pack as it was; if a picture is at fault, it leaves finished fields
/// to the next one, as a run that is killed does. One that is killed while it puts them into their
/// places leaves a pack that cannot be presented and that the next one completes. A run with
/// nothing to do leaves the pack's files untouched. Whether a picture or a field has changed, its
/// content tells. The pack's bytes depend only on key, study and images, not on the number of
/// threads. Images of more than PrepareOptions::large_image_px pixels are processed one after
/// another, so that the memory for a large image (docs/benchmarks/README.md) is needed only once,
/// whatever the number of threads.
/// \param lock  of the pack's folder, to prepare
/// \throws StudyError if an image cannot be read, with its place in the study
/// \throws FileError if the pack cannot be written, or belongs to another key
PrepareReport prepare_pack(const PackLock& lock, const StudyKey& key, const Progress& progress = {},
                           const PrepareOptions& options = {});

/// The same, with a lock of its own.
/// \throws FileError also if another process prepares or reads the pack
PrepareReport prepare_pack(const StudyKey& key, const std::filesystem::path& pack_folder,
                           const Progress& progress = {}, const PrepareOptions& options = {});

}  // namespace touchtrial::study
