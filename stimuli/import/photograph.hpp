/// \file One photograph, upright, grey, and in the size that it is felt in.
/// Private to stimuli/import.
#pragma once

#include "core/hash.hpp"
#include "core/plane.hpp"
#include "stimuli/import/import.hpp"

#include <filesystem>
#include <optional>

namespace touchtrial::stimuli {

struct Photograph {
  std::filesystem::path path;
  Digest sha256{};         ///< of the file
  Digest pixels_sha256{};  ///< of shape and grey levels, upright, before resampling
  int orientation = 1;     ///< as in Exif; undone
  int height_px = 0;       ///< upright, before resampling
  int width_px = 0;
  std::optional<double> said_pixels_per_mm;  ///< by the file
  double scale = 1.0;                        ///< of the resampling, pixels for a pixel
  GreyImage image;                           ///< upright and resampled
};

/// \throws FileError if the file cannot be read, does not say its resolution where it is to, or
///   would have to be enlarged or shrunk beyond reason
[[nodiscard]] Photograph read_photograph(const std::filesystem::path& path,
                                         const ImportOptions& options);

}  // namespace touchtrial::stimuli
