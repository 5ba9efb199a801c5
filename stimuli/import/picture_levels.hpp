/// \file Brightness, contrast and scale of a picture, and their equalising over a set.
/// Private to stimuli/import. Source: docs/own-images.md, "Equalising".
#pragma once

#include "core/plane.hpp"
#include "stimuli/import/import.hpp"

#include <optional>
#include <span>

namespace touchtrial::stimuli {

/// The mean that equalising gives: the wall's own grey.
inline constexpr double kEqualMeanGrey = 128.0;
/// Share of a picture's pixels at either end that may be clipped when contrasts are equalised.
inline constexpr double kTailShare = 0.0005;

struct PictureLevels {
  double mean_grey = 0.0;
  double rms_grey = 0.0;  ///< standard deviation
  int low_grey = 0;       ///< kTailShare of the pixels are darker
  int high_grey = 0;      ///< kTailShare of the pixels are brighter
  /// Characteristic wavelength, 2 pi rms / rms of the gradient (forward differences): that of the
  /// wave which rises and falls as steeply. 0 if nothing varies.
  double feature_px = 0.0;
};

/// \param picture  at least 1 x 1
[[nodiscard]] PictureLevels levels_of(const GreyImage& picture);

/// What every picture of a set is to have; nothing: what it has.
struct EqualLevels {
  std::optional<double> mean_grey;
  std::optional<double> rms_grey;
};

/// The mean is kEqualMeanGrey; the rms is the median of the set, or less, as much as every picture
/// can have without being clipped beyond its tails.
/// \param set  at least one, none of them constant
[[nodiscard]] EqualLevels equal_levels(std::span<const PictureLevels> set, LevelEqualising which);

struct EqualisedPicture {
  GreyImage picture;
  double clipped_share = 0.0;  ///< of the pixels
};

/// \param levels  those of the picture; not constant if the rms is to change
[[nodiscard]] EqualisedPicture equalised(const GreyImage& picture, const PictureLevels& levels,
                                         const EqualLevels& wanted);

}  // namespace touchtrial::stimuli
