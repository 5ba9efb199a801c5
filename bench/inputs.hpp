/// \file Input images, and reference results in double precision.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::bench {

/// \return the pictures of stimuli/ that fill their frame of 500 x 500 pixels, except the flat one
/// \throws FileError if one is missing
[[nodiscard]] std::vector<GreyImage> shipped_pictures();

/// \return the picture for timing (bark.png by default), cropped to a square or extended to one by
///   mirror images
[[nodiscard]] GreyImage timed_image(int size_px);
/// \throws FileError if the picture cannot be read
void choose_timed_picture(const std::filesystem::path& path);

/// The reference: the adaptive extraction of an image in double precision.
class ExtractionTruth {
 public:
  ExtractionTruth(const GreyImage& image, int radius);

  /// \return the largest error, in grey levels. Pixels whose CSGV is within 1e-3 of 2 or 128 are
  ///   ignored, because rounding may select another branch of the order map
  [[nodiscard]] double texture_error(const Plane<float>& texture) const;

 private:
  engine::Extraction<double> truth_;
};

/// TV-Gabor's default options, except for a gap that no solver reaches.
inline const engine::TvGaborOptions kUnreachableGap{.gap = -1.0};

/// \param image  not flat
/// \return TV-Gabor's v with the default options, after hundreds of steps in double
[[nodiscard]] Plane<double> tv_gabor_truth(const GreyImage& image);

}  // namespace touchtrial::bench
