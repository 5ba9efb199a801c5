/// \file The default pictures as files in a folder.
#pragma once

#include "stimuli/generator.hpp"
#include "stimuli/manifest.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace touchtrial::stimuli {

/// Told after each picture, for a progress bar: how many are done, of how many.
using StimuliProgress = std::function<void(int done, int total)>;

/// Which pictures to make.
struct StimuliChoice {
  std::uint64_t seed = kDefaultStimuliSeed;
  int size_px = kDefaultStimulusSizePx;
  /// Of every label but a flat one, of which one is enough; empty: as many as come with the
  /// program.
  std::optional<int> exemplars;
};

/// Makes every recipe and writes <label>.png files, further exemplars as
/// exemplars/<label>-<number>.png, and manifest.json. Each file replaces an older one of the same
/// set only when it is complete, the manifest last; then what the older set had more is removed,
/// where nobody has changed it. Other files in the folder stay.
/// \param folder  is made if it does not exist
/// \return the manifest that was written; its entries are in the order of `stimulus_recipes()`,
///   exemplars of a label together
/// \throws FileError if the folder or a file cannot be written, its manifest cannot be read, or a
///   picture is in the way that the manifest does not list; UsageError if the size or the number of
///   exemplars is out of range
StimulusManifest generate_default_stimuli(const std::filesystem::path& folder,
                                          const StimuliChoice& choice = {},
                                          const StimuliProgress& progress = {});

}  // namespace touchtrial::stimuli
