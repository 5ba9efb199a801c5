/// \file Measures brightness, contrast and feature size of pictures, and equalises the first two.
/// Private to stimuli/import. Source: docs/own-images.md, "Equalising".
#pragma once

#include "core/plane.hpp"
#include "stimuli/import/import.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::stimuli {

/// The mean of equalised pictures, equal to the grey of the flat wall.
inline constexpr double kEqualMeanGrey = 128.0;
/// The share of a picture's pixels that equalising may clip at either end.
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

/// \param numbers  at least one
[[nodiscard]] double median(std::vector<double> numbers);

/// \param picture  at least 1 x 1
[[nodiscard]] PictureLevels levels_of(const GreyImage& picture);

/// The target levels of a set. Each picture keeps a level that has no target.
struct EqualLevels {
  std::optional<double> mean_grey;
  std::optional<double> rms_grey;
};

/// The target mean is kEqualMeanGrey. The target rms is the median of the set, or less if a picture
/// would be clipped by more than kTailShare.
/// \param set  at least one picture, none of them constant
[[nodiscard]] EqualLevels equal_levels(std::span<const PictureLevels> set,
                                       LevelEqualising equalising);

struct EqualisedPicture {
  GreyImage picture;
  double clipped_share = 0.0;  ///< of the pixels
};

/// \param levels  of the picture; it must not be constant if the rms changes
[[nodiscard]] EqualisedPicture equalise_picture(const GreyImage& picture,
                                                const PictureLevels& levels,
                                                const EqualLevels& target);

}  // namespace touchtrial::stimuli
