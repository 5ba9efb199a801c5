/// \file The positions of crops. Private to stimuli/import.
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

/// The part of a photograph without a pixel of 0: one of at least `min_px` by `min_px` if there
/// is any, and of these the largest.
/// \return no pixels if all are 0
[[nodiscard]] PhotoPart opaque_part(const GreyImage& opacity, int min_px);

/// The pixels of a part that lies within the image.
[[nodiscard]] GreyImage cut(const GreyImage& image, const PhotoPart& part);

/// The top-left corner of a square crop.
struct CropPlace {
  int y = 0;
  int x = 0;

  friend bool operator==(const CropPlace&, const CropPlace&) = default;
};

/// The number of squares that fit on a grid without sharing a pixel.
[[nodiscard]] int separate_crops(PhotoSize photo, int side_px);

/// The number of squares that fit if neighbours share at most half their side.
[[nodiscard]] int overlapping_crops(PhotoSize photo, int side_px);

/// Different places: separate and at random distances if there is room, otherwise spread evenly
/// with as little overlap as possible.
/// \param count  0 .. overlapping_crops()
[[nodiscard]] std::vector<CropPlace> crop_places(PhotoSize photo, int side_px, int count,
                                                 RandomStream& random);

/// The number of crops of each photograph of a class: as even as possible, first without overlap.
/// \return empty if even overlapping crops are too few
[[nodiscard]] std::vector<int> crop_shares(std::span<const PhotoSize> photos, int side_px,
                                           int count);

}  // namespace touchtrial::stimuli
