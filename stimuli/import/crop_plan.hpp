/// \file Where crops are cut. Private to stimuli/import.
#pragma once

#include "core/random.hpp"

#include <span>
#include <string>
#include <vector>

namespace touchtrial::stimuli {

struct PhotoSize {
  int height_px = 0;
  int width_px = 0;
};

/// The top-left corner of a square crop.
struct CropPlace {
  int y = 0;
  int x = 0;

  friend bool operator==(const CropPlace&, const CropPlace&) = default;
};

/// Squares that fit without sharing a pixel, on a grid.
[[nodiscard]] int separate_crops(PhotoSize photo, int side_px);

/// Squares that fit where neighbours share at most half their side.
[[nodiscard]] int overlapping_crops(PhotoSize photo, int side_px);

/// Different places: separate ones while there are enough of them, at random distances; otherwise
/// spread evenly, with as little overlap as can be.
/// \param count  0 .. overlapping_crops()
[[nodiscard]] std::vector<CropPlace> crop_places(PhotoSize photo, int side_px, int count,
                                                 RandomStream& random);

/// How many crops each photograph of a class gives: as evenly as can be, first without overlap.
/// \return empty if they have not that many even with overlap
[[nodiscard]] std::vector<int> shared_out(std::span<const PhotoSize> photos, int side_px,
                                          int count);

}  // namespace touchtrial::stimuli
