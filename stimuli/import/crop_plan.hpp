/// \file Plans the positions of crops in photographs. Private to stimuli/import.
#pragma once

#include "core/plane.hpp"
#include "core/random.hpp"

#include <span>
#include <string>
#include <vector>

namespace touchtrial::stimuli {

struct PhotoSize {
  int height_px = 0;
  int width_px = 0;
};

/// A rectangle of a photograph.
struct PhotoPart {
  int x = 0;
  int y = 0;
  PhotoSize size_px;
};

/// The largest opaque rectangle of a photograph; prefers rectangles of at least `min_px` by
/// `min_px`.
/// \return an empty part if no pixel is opaque
[[nodiscard]] PhotoPart opaque_part(const GreyImage& opacity, int min_px);

/// The pixels of a part of the image.
[[nodiscard]] GreyImage crop_image(const GreyImage& image, const PhotoPart& part);

/// The top-left corner of a square crop.
struct CropPosition {
  int y = 0;
  int x = 0;

  friend bool operator==(const CropPosition&, const CropPosition&) = default;
};

/// The number of squares that fit on a grid without overlap.
[[nodiscard]] int separate_crops(PhotoSize photo, int side_px);

/// The number of squares that fit if neighbours overlap by at most half their side.
[[nodiscard]] int overlapping_crops(PhotoSize photo, int side_px);

/// Distinct positions of crops: separate and at random distances if there is room, otherwise evenly
/// spread with minimal overlap.
/// \param count  0 .. overlapping_crops()
[[nodiscard]] std::vector<CropPosition> crop_positions(PhotoSize photo, int side_px, int count,
                                                       RandomStream& random);

/// The number of crops from each photograph of a class, as equal as possible, preferring crops
/// without overlap.
/// \return empty if there is not enough room even with overlap
[[nodiscard]] std::vector<int> distribute_crops(std::span<const PhotoSize> photos, int side_px,
                                                int count);

}  // namespace touchtrial::stimuli
