/// \file The intensities by which textures are told apart when felt.
/// Source: docs/method.md, "Felt features".
#pragma once

#include <array>

namespace touchtrial::engine {

/// Octaves of wavelength on the plane, from the longest: 16 to 8 mm, 8 to 4, 4 to 2, 2 to 1, 1 to
/// 0.5.
inline constexpr int kFeltBands = 5;
inline constexpr double kLongestFeltMm = 16.0;
/// Directions of lateral force: 0, 45, 90, 135 degrees from the plane's x towards its y.
inline constexpr int kFeltDirections = 4;
/// Parts of the plane, three by three, row by row from the top left.
inline constexpr int kFeltPartsASide = 3;
inline constexpr int kFeltParts = kFeltPartsASide * kFeltPartsASide;

/// Where each kind of feature begins.
inline constexpr int kLateralBandsAt = 0;
inline constexpr int kNormalBandsAt = kLateralBandsAt + kFeltBands;
inline constexpr int kDirectionsAt = kNormalBandsAt + kFeltBands;
inline constexpr int kPartsAt = kDirectionsAt + kFeltDirections;
inline constexpr int kFeltFeatures = kPartsAt + kFeltParts;

/// Natural logarithms of root mean square forces in newtons: of the lateral force's bands, of the
/// normal force's bands, of the lateral force's component along each direction (all bands), and of
/// the lateral force on each part of the plane (all bands). Forces twice as strong add ln 2 to
/// each.
using FeltFeatures = std::array<double, kFeltFeatures>;

}  // namespace touchtrial::engine
