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
/// The longest vector, in bytes: accesses may exceed a row of a tile by this much.
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

/// The number of columns of the result processed at a time, so that a tile's data stay in the
/// first-level cache.
template <typename Real>
constexpr int kTile = kTileBytes / static_cast<int>(sizeof(Real));

template <typename Real>
struct alignas(64) Workspace {
  static constexpr int kSlack = kSlackBytes / static_cast<int>(sizeof(Real));
  /// u and v of one row of the images.
  alignas(64) Real pair[2][kTile<Real> + 2 * kSlack];
  /// u, v, u^2 and v^2, filtered along x, in sequence. Row y is in slot y mod kTaps.
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

/// Loads u and v of the samples starting at `start`.
template <class D>
HWY_INLINE void load_pair(D d, const GreySource& source, std::size_t start, hn::Vec<D>& u,
                          hn::Vec<D>& v) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const hn::Rebind<std::int32_t, D> integers;
  const auto x = hn::PromoteTo(integers, hn::LoadU(bytes, source.x + start));
  const auto y = hn::PromoteTo(integers, hn::LoadU(bytes, source.y + start));
  u = to_real(d, hn::Sub(hn::Add(x, y), hn::Set(integers, source.offsets.sum)));
  v = to_real(d, hn::Sub(hn::Sub(x, y), hn::Set(integers, source.offsets.difference)));
}

template <class D>
HWY_INLINE void load_pair(D d, const RealSource<hn::TFromD<D>>& source, std::size_t start,
                          hn::Vec<D>& u, hn::Vec<D>& v) {
  u = hn::LoadU(d, source.sum + start);
  v = hn::LoadU(d, source.difference + start);
}

template <class D, class Source, typename Real = hn::TFromD<D>>
HWY_INLINE void store_pair(D d, const Source& source, std::size_t start, int i,
                           Workspace<Real>& work) {
  hn::Vec<D> u;
  hn::Vec<D> v;
  load_pair(d, source, start, u, v);
  hn::StoreU(u, d, work.pair[0] + i);
  hn::StoreU(v, d, work.pair[1] + i);
}

/// Loads the part of an image row that the tile's windows cover.
template <class D, class Source, typename Real = hn::TFromD<D>>
HWY_INLINE void load_row(D d, const Source& source, int y, Tile tile, Workspace<Real>& work) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int needed_width = tile.width + 2 * kReach;
  const int available_width = source.width - tile.x0;
  const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(source.width) +
                            static_cast<std::size_t>(tile.x0);
  int i = 0;
  for (; i < needed_width && i + lanes <= available_width; i += lanes) {
    store_pair(d, source, first + static_cast<std::size_t>(i), i, work);
  }
  const hn::CappedTag<Real, 1> single;
  for (; i < needed_width; ++i)
    store_pair(single, source, first + static_cast<std::size_t>(i), i, work);
}

/// The weighted sum of the rows in `taps`, from the outermost pair inwards.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> window_sum(D d, const Real* HWY_RESTRICT weights, const Real* const* taps,
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

/// The window's weighted sums of a row's samples and of their squares, added in the same order as
/// in window_sum().
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void window_moments(D d, const Real* HWY_RESTRICT weights, const Real* samples,
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
      window_moments(d, weights, work.pair[p] + x, first, second);
      hn::Store(first, d, row + p * kTile<Real> + x);
      hn::Store(second, d, row + (p + 2) * kTile<Real> + x);
    }
  }
}

/// Half of the deficits of one vector of windows, or a sum of them.
template <class D>
struct HalfDeficits {
  hn::Vec<D> structure;
  hn::Vec<D> luminance;
};

/// Half of 1 - c s if the arguments are the variances of v and u; half of 1 - l if they are the
/// squares of their means.
template <class D>
HWY_INLINE hn::Vec<D> half_deficit(D d, hn::Vec<D> difference, hn::Vec<D> sum, double constant) {
  const auto total =
      hn::Add(hn::Add(sum, difference), hn::Set(d, static_cast<hn::TFromD<D>>(2 * constant)));
  return hn::Div(difference, total);
}

template <class D, bool kLuminance, typename Real = hn::TFromD<D>>
HWY_INLINE HalfDeficits<D> deficits_at(D d, const Real* HWY_RESTRICT weights,
                                       const Real* const* rows, int x, PairOffsets offsets) {
  const auto zero = hn::Zero(d);
  const auto u = window_sum(d, weights, rows, x);
  const auto v = window_sum(d, weights, rows, x + kTile<Real>);
  const auto uu = window_sum(d, weights, rows, x + 2 * kTile<Real>);
  const auto vv = window_sum(d, weights, rows, x + 3 * kTile<Real>);
  const auto variance_u = hn::Max(hn::NegMulAdd(u, u, uu), zero);
  const auto variance_v = hn::Max(hn::NegMulAdd(v, v, vv), zero);
  HalfDeficits<D> half{half_deficit(d, variance_v, variance_u, kC2), zero};
  if constexpr (kLuminance) {
    const auto sum = hn::Add(u, hn::Set(d, static_cast<Real>(offsets.sum)));
    const auto difference = hn::Add(v, hn::Set(d, static_cast<Real>(offsets.difference)));
    half.luminance = half_deficit(d, hn::Mul(difference, difference), hn::Mul(sum, sum), kC1);
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
    const auto is_inside = hn::FirstN(d, static_cast<std::size_t>(tile.width - x));
    HalfDeficits<D> last = deficits_at<D, kLuminance>(d, weights, rows, x, offsets);
    last.structure = hn::IfThenElseZero(is_inside, last.structure);
    last.luminance = hn::IfThenElseZero(is_inside, last.luminance);
    add_to(row, last);
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
  // Tiles are summed in order, so the result does not depend on the number of threads.
  std::vector<MeanDeficits> tiles(
      static_cast<std::size_t>((windows_x + kTile<Real> - 1) / kTile<Real>));
  const bool is_large = std::int64_t{source.height} * source.width >= kMinParallelPixels;
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

MeanDeficits grey_deficits_f32(const GreyPair& pair, Luminance luminance) {
  return deficits_of<float>(GreySource(pair), luminance);
}
MeanDeficits grey_deficits_f64(const GreyPair& pair, Luminance luminance) {
  return deficits_of<double>(GreySource(pair), luminance);
}
MeanDeficits real_deficits_f32(const SumDifference<float>& pair, Luminance luminance) {
  return deficits_of<float>(RealSource<float>(pair), luminance);
}
MeanDeficits real_deficits_f64(const SumDifference<double>& pair, Luminance luminance) {
  return deficits_of<double>(RealSource<double>(pair), luminance);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
HWY_EXPORT(grey_deficits_f32);
HWY_EXPORT(grey_deficits_f64);
HWY_EXPORT(real_deficits_f32);
HWY_EXPORT(real_deficits_f64);

template <>
MeanDeficits mean_deficits<float>(const GreyPair& pair, Luminance luminance) {
  return HWY_DYNAMIC_DISPATCH(grey_deficits_f32)(pair, luminance);
}
template <>
MeanDeficits mean_deficits<double>(const GreyPair& pair, Luminance luminance) {
  return HWY_DYNAMIC_DISPATCH(grey_deficits_f64)(pair, luminance);
}
template <>
MeanDeficits mean_deficits(const SumDifference<float>& pair, Luminance luminance) {
  return HWY_DYNAMIC_DISPATCH(real_deficits_f32)(pair, luminance);
}
template <>
MeanDeficits mean_deficits(const SumDifference<double>& pair, Luminance luminance) {
  return HWY_DYNAMIC_DISPATCH(real_deficits_f64)(pair, luminance);
}

}  // namespace touchtrial::engine
#endif
