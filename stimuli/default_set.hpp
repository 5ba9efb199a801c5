/// \file Writes the default pictures to a folder, with manifest.json, which describes them and how
/// to reproduce them.
#pragma once

#include "core/hash.hpp"
#include "stimuli/generator.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::stimuli {

inline constexpr std::string_view kStimulusManifestFile = "manifest.json";
/// Generated pictures are in the public domain.
inline constexpr std::string_view kStimuliLicence = "CC0-1.0";

/// One picture of the set.
struct StimulusEntry {
  std::string label;
  StimulusKind kind = StimulusKind::texture;
  int exemplar = 1;
  std::string file;  ///< path within the folder
  std::uint64_t seed = 0;
  int size_px = 0;
  Digest sha256{};         ///< of the file
  Digest pixels_sha256{};  ///< of the grey levels, row-major; equal on every machine

  friend bool operator==(const StimulusEntry&, const StimulusEntry&) = default;
};

struct StimulusManifest {
  int generator_version = kGeneratorVersion;
  std::string licence{kStimuliLicence};
  std::vector<StimulusEntry> entries;

  friend bool operator==(const StimulusManifest&, const StimulusManifest&) = default;
};

/// Writes the manifest; an older one is replaced only when the new one is complete.
/// \param path  of the file
/// \throws FileError if it cannot be written
void write_stimulus_manifest(const std::filesystem::path& path, const StimulusManifest& manifest);

/// \param path  of the file
/// \throws FileError naming the JSON pointer if the file is missing or not JSON, or a key is
///   missing or misspelt
[[nodiscard]] StimulusManifest read_stimulus_manifest(const std::filesystem::path& path);

/// Called after each picture, for a progress bar.
using StimuliProgress = std::function<void(int done, int total)>;

/// The pictures to generate.
struct StimuliChoice {
  std::uint64_t seed = kDefaultStimuliSeed;
  int size_px = kDefaultStimulusSizePx;
  /// Exemplars per label; empty: as in the shipped set. A flat label has only one.
  std::optional<int> exemplars;
  /// The kind of pictures; empty: all kinds.
  std::optional<StimulusKind> kind{};
};

/// Generates the chosen pictures as <label>.png, further exemplars as
/// exemplars/<label>-<number>.png, and manifest.json last. Replaces each file of an earlier set
/// only by a complete new one. Then removes unchanged pictures of the earlier set that the new set
/// lacks. Leaves other files unchanged.
/// \param folder  created if it does not exist
/// \return the manifest; its entries are in the order of `stimulus_recipes()`, grouped by label
/// \throws FileError if the folder or a file cannot be written, or a foreign file has a picture's
///   name
/// \throws UsageError if the size or the number of exemplars is out of range
StimulusManifest generate_default_stimuli(const std::filesystem::path& folder,
                                          const StimuliChoice& choice = {},
                                          const StimuliProgress& progress = {});

}  // namespace touchtrial::stimuli
