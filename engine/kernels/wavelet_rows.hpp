/// \file Rows of DAUB4 sub-bands in exact integers, vectorised for every target.
///
/// The taps are (1 + s, 3 + s, 3 - s, 1 - s) / (4 sqrt 2) with s = sqrt 3, so each filter gives a
/// number whole + root s with integer parts. Filtered along both axes, a sub-band is
/// (whole + root s) / 16, both parts in 16 bits for any 8-bit image. Nothing is rounded before
/// differences are taken: what a gradient loses does not depend on the image's brightness, a flat
/// image has exactly none, and a negative has exactly that of its positive.
#pragma once

#include <array>
#include <cstdint>

namespace touchtrial {

/// What the sub-bands of wavelet rows are divided by.
inline constexpr float kWaveletScale = 1.0F / 16;

/// Numbers whole + root sqrt 3, sample by sample.
struct RootRow {
  std::int16_t* whole = nullptr;
  std::int16_t* root = nullptr;
};

/// What one filtering gives.
struct LowHigh {
  RootRow low;
  RootRow high;
};

/// All rows below must have a vector of slack behind their samples; it may be overwritten.

/// Filters along x and keeps every second sample.
/// \param row  2 * count + 2 samples
void filter_along_x(const std::uint8_t* row, int count, const LowHigh& out);

/// Filters four rows, from top to bottom, along y, and halves both parts, which are even.
void filter_along_y(const std::array<RootRow, 4>& rows, int count, const LowHigh& out);

/// The same as values in single precision. \param low,high  receive `count` samples and no more
void filter_along_y(const std::array<RootRow, 4>& rows, int count, float* low, float* high);

/// A sub-band's values in single precision. \param out  receives `count` samples and no more
void sub_band_values(RootRow row, int count, float* out);

}  // namespace touchtrial
