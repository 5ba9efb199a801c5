/// \file Brightness, contrast and feature size of a picture, and their equalising over a set.
/// Private to stimuli/import. Source: docs/own-images.md, "Equalising".
#pragma once

#include "core/plane.hpp"
#include "stimuli/import/import.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::stimuli {

/// The mean of equalised pictures: the grey of the flat wall.
inline constexpr double kEqualMeanGrey = 128.0;
/// Share of a picture's pixels that equalising contrasts may clip at either end.
inline constexpr double kTailShare = 0.0005;

struct PictureLevels {
  double mean_grey = 0.0;
  double rms_grey = 0.0;  ///< standard deviation
  int low_grey = 0;       ///< kTailShare of the pixels are darker
  int high_grey = 0;      ///< kTailShare of the pixels are brighter
  /// Characteristic wavelength, 2 pi rms / rms of the gradient (forward differences): the
  /// wavelength of a sine with the same slopes. 0 in a constant picture.
  double feature_px = 0.0;
};

/// The mean of the middle two of an even number.
/// \param numbers  at least one
[[nodiscard]] double median(std::vector<double> numbers);

/// \param picture  at least 1 x 1
[[nodiscard]] PictureLevels levels_of(const GreyImage& picture);

/// The levels that every picture of a set gets; without a value, each picture keeps its own.
struct EqualLevels {
  std::optional<double> mean_grey;
  std::optional<double> rms_grey;
};

/// The mean is kEqualMeanGrey; the rms is the median of the set, or the largest that every picture
/// can have without clipping beyond its tails if that is less.
/// \param set  at least one picture, none of them constant
[[nodiscard]] EqualLevels equal_levels(std::span<const PictureLevels> set, LevelEqualising which);

struct EqualisedPicture {
  GreyImage picture;
  double clipped_share = 0.0;  ///< of the pixels
};

/// \param levels  of the picture; it must not be constant if the rms changes
[[nodiscard]] EqualisedPicture equalised(const GreyImage& picture, const PictureLevels& levels,
                                         const EqualLevels& wanted);

}  // namespace touchtrial::stimuli
