/// \file The felt intensities that distinguish textures. Source: docs/method.md, "Felt features".
#pragma once

#include <array>

namespace touchtrial::engine {

/// Octaves of wavelength on the plane, longest first: 16 to 8 mm, 8 to 4, 4 to 2, 2 to 1, 1 to 0.5.
inline constexpr int kFeltBands = 5;
inline constexpr double kMaxFeltMm = 16.0;
/// Directions of lateral force: 0, 45, 90 and 135 degrees from the plane's x towards its y.
inline constexpr int kFeltDirections = 4;
/// Parts of the plane: a 3 x 3 grid, row by row from the top left.
inline constexpr int kFeltPartsPerSide = 3;
inline constexpr int kFeltParts = kFeltPartsPerSide * kFeltPartsPerSide;

/// The index of the first feature of each kind.
inline constexpr int kLateralBandsAt = 0;
inline constexpr int kNormalBandsAt = kLateralBandsAt + kFeltBands;
inline constexpr int kDirectionsAt = kNormalBandsAt + kFeltBands;
inline constexpr int kPartsAt = kDirectionsAt + kFeltDirections;
inline constexpr int kFeltFeatures = kPartsAt + kFeltParts;

/// Natural logarithms of root mean square forces in newtons, or of accelerations relative to their
/// threshold: in the lateral bands, in the normal bands, in the lateral component along each
/// direction (all bands), and laterally on each part of the plane (all bands).
using FeltFeatures = std::array<double, kFeltFeatures>;

}  // namespace touchtrial::engine
