/// \file manifest.json: what lies in a folder of generated pictures and how to make it again.
#pragma once

#include "core/hash.hpp"
#include "stimuli/generator.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::stimuli {

inline constexpr std::string_view kStimulusManifestFile = "manifest.json";
/// Generated pictures belong to nobody.
inline constexpr std::string_view kStimuliLicence = "CC0-1.0";

/// One picture of the folder.
struct StimulusEntry {
  std::string label;
  StimulusKind kind = StimulusKind::texture;
  int exemplar = 1;
  std::string file;  ///< path inside the folder
  std::uint64_t seed = 0;
  int size_px = 0;
  Digest sha256{};         ///< of the file
  Digest pixels_sha256{};  ///< of the grey levels, row-major: the same on every machine

  friend bool operator==(const StimulusEntry&, const StimulusEntry&) = default;
};

struct StimulusManifest {
  int generator_version = kGeneratorVersion;
  std::string licence{kStimuliLicence};
  std::vector<StimulusEntry> entries;

  friend bool operator==(const StimulusManifest&, const StimulusManifest&) = default;
};

/// Writes the manifest, replacing an older one only when the new one is complete.
/// \param path  of the file \throws FileError if it cannot be written
void write_stimulus_manifest(const std::filesystem::path& path, const StimulusManifest& manifest);

/// \throws FileError if the file is missing, not JSON, or lacks or misspells a key; the message
///   holds the JSON pointer
[[nodiscard]] StimulusManifest read_stimulus_manifest(const std::filesystem::path& path);

}  // namespace touchtrial::stimuli
