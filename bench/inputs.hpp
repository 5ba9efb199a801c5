/// \file The input images, and reference results in double precision.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::bench {

/// The pictures of stimuli/ that fill their frame, 500 x 500, without the flat one.
/// \throws FileError if one is missing
[[nodiscard]] std::vector<GreyImage> shipped_pictures();

/// A square of any size from the picture for timing, bark.png by default. It is extended beyond the
/// edge by mirror images, so that there is no seam.
[[nodiscard]] GreyImage timed_image(int size_px);
/// \throws FileError if the picture cannot be read
void choose_timed_picture(const std::filesystem::path& path);

/// The adaptive extraction of an image in double.
class ExtractionTruth {
 public:
  ExtractionTruth(const GreyImage& image, int radius);

  /// The largest error, in grey levels. Pixels whose CSGV is within 1e-3 of 2 or 128 do not count:
  /// there, two orders of summation may take different branches of the order map.
  [[nodiscard]] double texture_error(const Plane<float>& texture) const;

 private:
  engine::Extraction<double> truth_;
};

/// TV-Gabor's default options, except for a gap that no solver reaches.
inline const engine::TvGaborOptions kEndless{.gap = -1.0};

/// TV-Gabor's v under the default options after hundreds of steps in double.
/// \param image  not flat
[[nodiscard]] Plane<double> tv_gabor_truth(const GreyImage& image);

}  // namespace touchtrial::bench
