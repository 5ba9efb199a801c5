#include "engine/metrics/ssim_deficits.hpp"

#include "core/parallel.hpp"
#include "engine/kernels/strips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/metrics/ssim_deficits.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef TOUCHTRIAL_SSIM_DEFICITS_ONCE
#define TOUCHTRIAL_SSIM_DEFICITS_ONCE
namespace touchtrial::engine {
namespace {

constexpr int kTaps = 11;
constexpr int kReach = kTaps / 2;
constexpr double kSigma = 1.5;
constexpr double kC1 = (0.01 * 255) * (0.01 * 255);
constexpr double kC2 = (0.03 * 255) * (0.03 * 255);
constexpr int kMoments = 4;
constexpr int kTileBytes = 512;
/// The longest vector, in bytes: how far accesses may go beyond the end of a row of a tile.
constexpr int kSlackBytes = 64;

/// The Gaussian from its centre outwards; the centre and both wings sum to 1.
template <typename Real>
std::array<Real, kReach + 1> window_weights() {
  std::array<double, kReach + 1> weights{};
  double sum = 0.0;
  for (int i = 0; i <= kReach; ++i) {
    weights[i] = std::exp(-i * i / (2 * kSigma * kSigma));
    sum += i == 0 ? weights[i] : 2 * weights[i];
  }
  std::array<Real, kReach + 1> normalised{};
  for (int i = 0; i <= kReach; ++i) normalised[i] = static_cast<Real>(weights[i] / sum);
  return normalised;
}

/// How many columns of the result are processed at a time, from top to bottom: the data of a tile
/// stay in the first-level cache.
template <typename Real>
constexpr int kTile = kTileBytes / static_cast<int>(sizeof(Real));

template <typename Real>
struct alignas(64) Workspace {
  static constexpr int kSlack = kSlackBytes / static_cast<int>(sizeof(Real));
  /// u and v of one row of the images.
  alignas(64) Real pair[2][kTile<Real> + 2 * kSlack];
  /// u, v, u^2 and v^2, filtered along x, one behind the other. Row y is in slot y mod kTaps.
  alignas(64) Real filtered[kTaps][kMoments * kTile<Real>];
};

/// A part of the result: the windows whose left edge is at x0 .. x0 + width - 1.
struct Tile {
  int x0;
  int width;
};

/// The samples of the first scale, as bytes.
struct GreySource {
  explicit GreySource(const GreyPair& pair)
      : x(pair.x.samples().data()),
        y(pair.y.samples().data()),
        offsets(pair.offsets),
        height(pair.x.height()),
        width(pair.x.width()) {}
  const std::uint8_t* x;
  const std::uint8_t* y;
  PairOffsets offsets;
  int height;
  int width;
};

/// The samples of a further scale.
template <typename Real>
struct RealSource {
  explicit RealSource(const SumDifference<Real>& pair)
      : sum(pair.sum.samples().data()),
        difference(pair.difference.samples().data()),
        offsets(pair.offsets),
        height(pair.sum.height()),
        width(pair.sum.width()) {}
  const Real* sum;
  const Real* difference;
  PairOffsets offsets;
  int height;
  int width;
};

}  // namespace
}  // namespace touchtrial::engine
#endif

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
HWY_INLINE hn::Vec<D> to_real(D d, hn::Vec<hn::Rebind<std::int32_t, D>> integers) {
  if constexpr (sizeof(hn::TFromD<D>) == sizeof(float)) {
    return hn::ConvertTo(d, integers);
  } else {
    return hn::PromoteTo(d, integers);
  }
}

/// Loads u and v of the samples from `at` on.
template <class D>
HWY_INLINE void load_pair(D d, const GreySource& source, std::size_t at, hn::Vec<D>& u,
                          hn::Vec<D>& v) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const hn::Rebind<std::int32_t, D> integers;
  const auto x = hn::PromoteTo(integers, hn::LoadU(bytes, source.x + at));
  const auto y = hn::PromoteTo(integers, hn::LoadU(bytes, source.y + at));
  u = to_real(d, hn::Sub(hn::Add(x, y), hn::Set(integers, source.offsets.sum)));
  v = to_real(d, hn::Sub(hn::Sub(x, y), hn::Set(integers, source.offsets.difference)));
}

template <class D>
HWY_INLINE void load_pair(D d, const RealSource<hn::TFromD<D>>& source, std::size_t at,
                          hn::Vec<D>& u, hn::Vec<D>& v) {
  u = hn::LoadU(d, source.sum + at);
  v = hn::LoadU(d, source.difference + at);
}

template <class D, class Source, typename Real = hn::TFromD<D>>
HWY_INLINE void store_pair(D d, const Source& source, std::size_t at, int i,
                           Workspace<Real>& work) {
  hn::Vec<D> u;
  hn::Vec<D> v;
  load_pair(d, source, at, u, v);
  hn::StoreU(u, d, work.pair[0] + i);
  hn::StoreU(v, d, work.pair[1] + i);
}

/// Loads one row of the images, as far as the tile's windows reach.
template <class D, class Source, typename Real = hn::TFromD<D>>
HWY_INLINE void load_row(D d, const Source& source, int y, Tile tile, Workspace<Real>& work) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int wanted = tile.width + 2 * kReach;
  const int available = source.width - tile.x0;
  const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(source.width) +
                            static_cast<std::size_t>(tile.x0);
  int i = 0;
  for (; i < wanted && i + lanes <= available; i += lanes) {
    store_pair(d, source, first + static_cast<std::size_t>(i), i, work);
  }
  const hn::CappedTag<Real, 1> one;
  for (; i < wanted; ++i) store_pair(one, source, first + static_cast<std::size_t>(i), i, work);
}

/// The window's weighted sum of the rows that the taps point to, from the outermost pair inwards.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> windowed(D d, const Real* HWY_RESTRICT weights, const Real* const* taps,
                               int offset) {
  auto sum = hn::Mul(hn::Set(d, weights[kReach]), hn::Add(hn::LoadU(d, taps[0] + offset),
                                                          hn::LoadU(d, taps[kTaps - 1] + offset)));
  for (int i = kReach - 1; i > 0; --i) {
    const auto wings =
        hn::Add(hn::LoadU(d, taps[kReach - i] + offset), hn::LoadU(d, taps[kReach + i] + offset));
    sum = hn::MulAdd(hn::Set(d, weights[i]), wings, sum);
  }
  return hn::MulAdd(hn::Set(d, weights[0]), hn::LoadU(d, taps[kReach] + offset), sum);
}

/// The window's weighted sums of a row's samples and of their squares, as windowed() forms them.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void windowed_moments(D d, const Real* HWY_RESTRICT weights, const Real* samples,
                                 hn::Vec<D>& first, hn::Vec<D>& second) {
  first = second = hn::Zero(d);
  for (int i = kReach; i > 0; --i) {
    const auto weight = hn::Set(d, weights[i]);
    const auto left = hn::LoadU(d, samples + kReach - i);
    const auto right = hn::LoadU(d, samples + kReach + i);
    first = hn::MulAdd(weight, hn::Add(left, right), first);
    second = hn::MulAdd(weight, hn::MulAdd(left, left, hn::Mul(right, right)), second);
  }
  const auto centre = hn::LoadU(d, samples + kReach);
  const auto weighted_centre = hn::Mul(hn::Set(d, weights[0]), centre);
  first = hn::Add(weighted_centre, first);
  second = hn::MulAdd(weighted_centre, centre, second);
}

template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void filter_row(D d, const Real* HWY_RESTRICT weights, Tile tile, int slot,
                           Workspace<Real>& work) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  Real* const row = work.filtered[slot];
  for (int x = 0; x < tile.width; x += lanes) {
    for (int p = 0; p < 2; ++p) {
      hn::Vec<D> first;
      hn::Vec<D> second;
      windowed_moments(d, weights, work.pair[p] + x, first, second);
      hn::Store(first, d, row + p * kTile<Real> + x);
      hn::Store(second, d, row + (p + 2) * kTile<Real> + x);
    }
  }
}

/// Half of the deficits of one vector of windows, or of the sum of several.
template <class D>
struct HalfDeficits {
  hn::Vec<D> structure;
  hn::Vec<D> luminance;
};

/// Half of 1 - c s if the arguments are the variances of v and u; half of 1 - l if they are the
/// squares of their means.
template <class D>
HWY_INLINE hn::Vec<D> share(D d, hn::Vec<D> difference, hn::Vec<D> sum, double constant) {
  const auto total =
      hn::Add(hn::Add(sum, difference), hn::Set(d, static_cast<hn::TFromD<D>>(2 * constant)));
  return hn::Div(difference, total);
}

template <class D, bool kLuminance, typename Real = hn::TFromD<D>>
HWY_INLINE HalfDeficits<D> deficits_at(D d, const Real* HWY_RESTRICT weights,
                                       const Real* const* rows, int x, PairOffsets offsets) {
  const auto zero = hn::Zero(d);
  const auto u = windowed(d, weights, rows, x);
  const auto v = windowed(d, weights, rows, x + kTile<Real>);
  const auto uu = windowed(d, weights, rows, x + 2 * kTile<Real>);
  const auto vv = windowed(d, weights, rows, x + 3 * kTile<Real>);
  const auto variance_u = hn::Max(hn::NegMulAdd(u, u, uu), zero);
  const auto variance_v = hn::Max(hn::NegMulAdd(v, v, vv), zero);
  HalfDeficits<D> half{share(d, variance_v, variance_u, kC2), zero};
  if constexpr (kLuminance) {
    const auto sum = hn::Add(u, hn::Set(d, static_cast<Real>(offsets.sum)));
    const auto difference = hn::Add(v, hn::Set(d, static_cast<Real>(offsets.difference)));
    half.luminance = share(d, hn::Mul(difference, difference), hn::Mul(sum, sum), kC1);
  }
  return half;
}

template <class D>
HWY_INLINE void add_to(HalfDeficits<D>& sum, const HalfDeficits<D>& part) {
  sum.structure = hn::Add(sum.structure, part.structure);
  sum.luminance = hn::Add(sum.luminance, part.luminance);
}

template <class D>
HWY_INLINE double total_of(D d, hn::Vec<D> lanes) {
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, lanes)));
}

/// Adds the deficits of one row of windows. Sums of one tile's width are in Real, the total in
/// double.
template <class D, bool kLuminance, typename Real = hn::TFromD<D>>
HWY_INLINE void add_row(D d, const Real* HWY_RESTRICT weights, const Real* const* rows, Tile tile,
                        PairOffsets offsets, MeanDeficits& sum) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  HalfDeficits<D> row{hn::Zero(d), hn::Zero(d)};
  int x = 0;
  for (; x + lanes <= tile.width; x += lanes) {
    add_to(row, deficits_at<D, kLuminance>(d, weights, rows, x, offsets));
  }
  if (x < tile.width) {
    const auto inside = hn::FirstN(d, static_cast<std::size_t>(tile.width - x));
    HalfDeficits<D> rest = deficits_at<D, kLuminance>(d, weights, rows, x, offsets);
    rest.structure = hn::IfThenElseZero(inside, rest.structure);
    rest.luminance = hn::IfThenElseZero(inside, rest.luminance);
    add_to(row, rest);
  }
  sum.structure += 2 * total_of(d, row.structure);
  if constexpr (kLuminance) sum.luminance += 2 * total_of(d, row.luminance);
}

template <typename Real, bool kLuminance, class Source>
MeanDeficits sums_of_tile(const Source& source, Tile tile) {
  MeanDeficits sum;
  const hn::ScalableTag<Real> d;
  const auto weights = window_weights<Real>();
  Workspace<Real> work{};
  for (int y = 0; y < source.height; ++y) {
    load_row(d, source, y, tile, work);
    filter_row(d, weights.data(), tile, y % kTaps, work);
    if (y < kTaps - 1) continue;
    const Real* rows[kTaps];
    for (int k = 0; k < kTaps; ++k) rows[k] = work.filtered[(y + 1 + k) % kTaps];
    add_row<hn::ScalableTag<Real>, kLuminance>(d, weights.data(), rows, tile, source.offsets, sum);
  }
  return sum;
}

template <typename Real, bool kLuminance, class Source>
HWY_INLINE MeanDeficits deficits_of(const Source& source) {
  const int windows_x = source.width - 2 * kReach;
  const int windows_y = source.height - 2 * kReach;
  // Sums of tiles, added in their order: the same digits for any number of threads.
  std::vector<MeanDeficits> tiles(
      static_cast<std::size_t>((windows_x + kTile<Real> - 1) / kTile<Real>));
  const bool is_large = std::int64_t{source.height} * source.width >= kThreadsFromPixels;
  in_parallel(is_large ? 0 : 1, tiles.size(), [&](std::size_t i) HWY_ATTR {
    const int x0 = static_cast<int>(i) * kTile<Real>;
    tiles[i] =
        sums_of_tile<Real, kLuminance>(source, Tile{x0, std::min(kTile<Real>, windows_x - x0)});
  });
  MeanDeficits sum;
  for (const MeanDeficits& tile : tiles) {
    sum.structure += tile.structure;
    sum.luminance += tile.luminance;
  }
  const double windows = static_cast<double>(windows_x) * static_cast<double>(windows_y);
  return {sum.structure / windows, sum.luminance / windows};
}

template <typename Real, class Source>
HWY_INLINE MeanDeficits deficits_of(const Source& source, Luminance luminance) {
  return luminance == Luminance::include ? deficits_of<Real, true>(source)
                                         : deficits_of<Real, false>(source);
}

MeanDeficits grey_float(const GreyPair& pair, Luminance luminance) {
  return deficits_of<float>(GreySource(pair), luminance);
}
MeanDeficits grey_double(const GreyPair& pair, Luminance luminance) {
  return deficits_of<double>(GreySource(pair), luminance);
}
MeanDeficits real_float(const SumDifference<float>& pair, Luminance luminance) {
  return deficits_of<float>(RealSource<float>(pair), luminance);
}
MeanDeficits real_double(const SumDifference<double>& pair, Luminance luminance) {
  return deficits_of<double>(RealSource<double>(pair), luminance);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
HWY_EXPORT(grey_float);
HWY_EXPORT(grey_double);
HWY_EXPORT(real_float);
HWY_EXPORT(real_double);

template <>
MeanDeficits mean_deficits<float>(const GreyPair& pair, Luminance luminance) {
  return HWY_DYNAMIC_DISPATCH(grey_float)(pair, luminance);
}
template <>
MeanDeficits mean_deficits<double>(const GreyPair& pair, Luminance luminance) {
  return HWY_DYNAMIC_DISPATCH(grey_double)(pair, luminance);
}
template <>
MeanDeficits mean_deficits(const SumDifference<float>& pair, Luminance luminance) {
  return HWY_DYNAMIC_DISPATCH(real_float)(pair, luminance);
}
template <>
MeanDeficits mean_deficits(const SumDifference<double>& pair, Luminance luminance) {
  return HWY_DYNAMIC_DISPATCH(real_double)(pair, luminance);
}

}  // namespace touchtrial::engine
#endif
