/// \file Rows of DAUB4 sub-bands in exact integers, vectorised for every target.
///
/// The taps are (1 + s, 3 + s, 3 - s, 1 - s) / (4 sqrt 2) with s = sqrt 3, so a filter gives whole
/// numbers: `whole` + `root` s. With s = 5042 / 2911, nearer than a float comes to it, a sub-band
/// of an 8-bit image is a whole number of 26 bits divided by kWaveletDivisor. Nothing is rounded
/// before differences are taken: what a gradient loses does not depend on the image's brightness, a
/// flat image has exactly none, and a negative has exactly that of its positive.
#pragma once

#include <array>
#include <cstdint>

namespace touchtrial::engine {

/// The approximation to sqrt 3; from the Pell equation 5042^2 - 3 * 2911^2 = 1.
inline constexpr int kRootNumerator = 5042;
inline constexpr int kRootDenominator = 2911;

/// What the whole numbers are divided by. Its reciprocal as a float is so near that every quotient
/// that a float can hold comes out exactly.
inline constexpr int kWaveletDivisor = 32 * kRootDenominator;
inline constexpr float kWaveletScale = 1.0F / static_cast<float>(kWaveletDivisor);

/// Rows filtered along y, whole and root of the low and of the high filter.
struct FilteredRows {
  std::int16_t* low_whole = nullptr;
  std::int16_t* low_root = nullptr;
  std::int16_t* high_whole = nullptr;
  std::int16_t* high_root = nullptr;
};

/// One row of each sub-band, in the order ll, lh, hl, hh: the first letter is the filter along x.
template <typename Sample>
using BandRows = std::array<Sample*, 4>;

/// What the Sobel gradient of the sub-bands needs of three rows, kept up row by row.
/// All rows have a vector of slack before and behind them, which may be overwritten.
struct SobelRows {
  BandRows<std::int32_t> last;        ///< the last row of each sub-band
  BandRows<std::int32_t> pairs;       ///< the last two rows added up
  BandRows<std::int32_t> smoothed;    ///< out: [1 2 1] of the last three rows, along y
  BandRows<std::int32_t> difference;  ///< out: the last less the last but two
};

/// Filters four rows of an image, from top to bottom, along y.
/// \param width  >= 1; no more than this many samples are read
/// \param out  receives `width` samples each; a vector behind them may be overwritten
void filter_along_y(const std::array<const std::uint8_t*, 4>& rows, int width,
                    const FilteredRows& out);

/// Filters along x, keeping every second sample, and moves `out` on by that row of the sub-bands.
/// \param rows  2 * count + 2 samples each, and two vectors of slack
void filter_along_x(const FilteredRows& rows, int count, const SobelRows& out);

/// The same, giving the sub-bands' values in single precision.
/// \param out  receives `count` samples each and no more
void filter_along_x(const FilteredRows& rows, int count, const BandRows<float>& out);

}  // namespace touchtrial::engine
