/// \file Makes the pack of a study: only what is missing or changed.
#pragma once

#include "engine/pack/pack.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/stage_log.hpp"
#include "protocols/design/study_key.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchtrial::design {

/// Where a study's pack and key lie.
struct PackPlace {
  std::filesystem::path pack;
  std::filesystem::path key;
};

/// `<study>.pack` and `<study>.key` beside the study file.
[[nodiscard]] PackPlace default_pack_place(const std::filesystem::path& study_file);
/// `<study>.sim.pack` beside the study file; the key is empty, because each simulated database has
/// its own copy of it.
[[nodiscard]] PackPlace simulated_pack_place(const std::filesystem::path& study_file);
/// DIR, and DIR with `.key` for `.pack`.
[[nodiscard]] PackPlace pack_place_at(const std::filesystem::path& pack_folder);

/// What became of one stimulus. For people who prepare, never for a running study.
struct PreparedStimulus {
  std::string class_label;
  int exemplar = 0;
  std::string method;  ///< its label
  bool reused = false;
  engine::FieldStatistics statistics;  ///< zeros if they were not asked for
  engine::Gains gains;
  double seconds = 0.0;
  std::uintmax_t bytes = 0;
  std::vector<engine::Stage> stages;  ///< if an explanation was asked for
};

/// Work that was not done, and why.
struct SkippedWork {
  std::string what;
  std::string why;
  std::uintmax_t bytes = 0;  ///< that were not written for it
};

struct PrepareReport {
  std::vector<PreparedStimulus> stimuli;
  std::vector<SkippedWork> skipped;
  std::vector<std::string> warnings;
  std::vector<engine::Stage>
      study_stages;  ///< of all stimuli together, if an explanation was asked for
};

inline constexpr std::int64_t kLargeImagePixels = std::int64_t{1} << 22;

/// What is wanted besides the pack.
struct PrepareOptions {
  bool statistics = true;  ///< PreparedStimulus::statistics: two Fourier transforms a stimulus
  bool explain = false;    ///< the stages, with their times and bytes
  bool wait = false;       ///< while another process prepares the pack, in place of an error
  std::int64_t large_image_px = kLargeImagePixels;  ///< from one more pixel on, one at a time
};

/// Whether every image that the study presents is there; to be asked before anything is written.
/// \throws StudyError with the place of the first that is not
void check_images_exist(const Study& study);

/// Called after each stimulus, from any thread but never twice at a time.
using Progress = std::function<void(int done, int of)>;

/// Extracts, renders and writes every presented stimulus whose field is missing, damaged or made
/// from other input; chooses gains; writes the table of contents; removes fields that no stimulus
/// has any more. A run that is interrupted leaves a pack from which nothing is presented and which
/// the next run completes; a run that has nothing to do leaves the pack's files untouched.
/// The pack's bytes depend on key, study and images alone, not on the number of threads.
/// Images of more than kLargeImagePixels are worked on one after another: what a large one needs
/// (docs/benchmarks/memory.md) is needed once, whatever the number of threads.
/// \throws StudyError if an image cannot be read, with its place in the study
/// \throws FileError if the pack cannot be written, is being prepared by another process, or
///   belongs to another key
PrepareReport prepare_pack(const StudyKey& key, const std::filesystem::path& pack_folder,
                           const Progress& progress = {}, const PrepareOptions& options = {});

}  // namespace touchtrial::design
