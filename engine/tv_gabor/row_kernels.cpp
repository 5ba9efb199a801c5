#include "engine/tv_gabor/row_kernels.hpp"

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/tv_gabor/row_kernels.cpp"

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <typename Values>
struct Pair {
  Values x;
  Values y;
};

template <class D>
using PairOf = Pair<hn::Vec<D>>;

template <class D>
HWY_INLINE PairOf<D> load(D d, const hn::TFromD<D>* x, const hn::TFromD<D>* y) {
  return {hn::LoadU(d, x), hn::LoadU(d, y)};
}

template <class D>
HWY_INLINE void store(D d, const PairOf<D>& pair, hn::TFromD<D>* x, hn::TFromD<D>* y) {
  hn::StoreU(pair.x, d, x);
  hn::StoreU(pair.y, d, y);
}

/// The gradient at `here`, whose right neighbours start at `right`.
template <class D>
HWY_INLINE PairOf<D> gradient(D d, const hn::TFromD<D>* here, const hn::TFromD<D>* right,
                              const hn::TFromD<D>* below) {
  const auto centre = hn::LoadU(d, here);
  return {hn::Sub(hn::LoadU(d, right), centre), hn::Sub(hn::LoadU(d, below), centre)};
}

template <class V>
HWY_INLINE V norm(const Pair<V>& pair) {
  return hn::Sqrt(hn::MulAdd(pair.x, pair.x, hn::Mul(pair.y, pair.y)));
}

/// limit / max(|pair|, limit)
template <class D, class V = hn::Vec<D>, hwy::EnableIf<sizeof(hn::TFromD<D>) == 8>* = nullptr>
HWY_INLINE V share_within(D, const Pair<V>& pair, V limit) {
  return hn::Div(limit, hn::Max(norm(pair), limit));
}

/// The same to the last digit or two, at a third of the time of a square root and a division: an
/// approximate root and a step of Newton's method. Exactly 1 within the limit.
template <class D, class V = hn::Vec<D>, hwy::EnableIf<sizeof(hn::TFromD<D>) == 4>* = nullptr>
HWY_INLINE V share_within(D d, const Pair<V>& pair, V limit) {
  const V one = hn::Set(d, 1.0F);
  const V squared = hn::MulAdd(pair.x, pair.x, hn::Mul(pair.y, pair.y));
  const V limit_squared = hn::Mul(limit, limit);
  const V safe = hn::Max(squared, limit_squared);
  const V root = hn::ApproximateReciprocalSqrt(safe);
  const V halved = hn::Mul(hn::Mul(hn::Set(d, 0.5F), safe), root);
  const V share =
      hn::Mul(limit, hn::MulAdd(root, hn::NegMulAdd(halved, root, hn::Set(d, 0.5F)), root));
  return hn::IfThenElse(hn::Gt(squared, limit_squared), share, one);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Pair<V> clipped(D d, const Pair<V>& pair, V limit) {
  const V share = share_within(d, pair, limit);
  return {hn::Mul(share, pair.x), hn::Mul(share, pair.y)};
}

template <class V>
HWY_INLINE V target(V image, V z, V b) {
  return hn::Add(hn::Sub(image, z), hn::Add(b, b));
}

/// relaxation * grad u + (1 - relaxation) * w + b, with w = z - b
template <class V>
HWY_INLINE V mapped(V u, V z, V b, V relaxation) {
  const V w = hn::Sub(z, b);
  return hn::Add(hn::MulAdd(relaxation, hn::Sub(u, w), w), b);
}

/// Prefetches the sample `width` further on, in the next row; the transforms between two rows hide
/// the latency.
template <typename Real>
HWY_INLINE void prefetch(const Real* sample, std::size_t width) {
  hwy::Prefetch(sample + width);
}

/// Maps as many samples of a row as d has lanes, from i on; `right` is the distance to the right
/// neighbour.
template <class D, typename Real>
HWY_INLINE void map_samples(D d, const AdmmRow<Real>& row, std::size_t width,
                            const AdmmNumbers<Real>& numbers, std::size_t i, std::ptrdiff_t right) {
  prefetch(row.z_x + i, width);
  prefetch(row.z_y + i, width);
  prefetch(row.image_below + i, width);
  const auto relaxation = hn::Set(d, numbers.relaxation);
  const auto momentum = hn::Set(d, numbers.momentum);
  const auto limit = hn::Set(d, numbers.limit);
  const auto f = gradient(d, row.image + i, row.image + i + right, row.image_below + i);
  const auto v = gradient(d, row.texture + i, row.texture + i + right, row.texture_below + i);
  const auto z = load(d, row.z_x + i, row.z_y + i);
  const auto b = clipped(d, z, limit);
  const PairOf<D> next = {mapped(hn::Sub(f.x, v.x), z.x, b.x, relaxation),
                          mapped(hn::Sub(f.y, v.y), z.y, b.y, relaxation)};
  PairOf<D> ahead = next;
  if (numbers.momentum != 0) {
    prefetch(row.former_x + i, width);
    prefetch(row.former_y + i, width);
    const auto former = load(d, row.former_x + i, row.former_y + i);
    ahead = {hn::MulAdd(momentum, hn::Sub(next.x, former.x), next.x),
             hn::MulAdd(momentum, hn::Sub(next.y, former.y), next.y)};
  }
  if (numbers.keep_former) store(d, next, row.former_x + i, row.former_y + i);
  store(d, ahead, row.z_x + i, row.z_y + i);
  const auto next_b = clipped(d, ahead, limit);
  if (numbers.b_alone) return store(d, next_b, row.target_x + i, row.target_y + i);
  store(d, PairOf<D>{target(f.x, ahead.x, next_b.x), target(f.y, ahead.y, next_b.y)},
        row.target_x + i, row.target_y + i);
}

template <class D, typename Real>
HWY_INLINE void restart_samples(D d, const AdmmRow<Real>& row, const RestartNumbers<Real>& numbers,
                                std::size_t i, std::ptrdiff_t right) {
  const auto f = gradient(d, row.image + i, row.image + i + right, row.image_below + i);
  const auto former = load(d, row.z_x + i, row.z_y + i);
  const auto former_b = clipped(d, former, hn::Set(d, numbers.former_limit));
  const auto ratio = hn::Set(d, numbers.limit / numbers.former_limit);
  const PairOf<D> b = {hn::Mul(ratio, former_b.x), hn::Mul(ratio, former_b.y)};
  const PairOf<D> z = {hn::Add(hn::Sub(former.x, former_b.x), b.x),
                       hn::Add(hn::Sub(former.y, former_b.y), b.y)};
  store(d, z, row.z_x + i, row.z_y + i);
  store(d, PairOf<D>{target(f.x, z.x, b.x), target(f.y, z.y, b.y)}, row.target_x + i,
        row.target_y + i);
}

/// Calls visit(descriptor, index) for whole vectors, then for shorter ones and single samples.
template <typename Real, class Visit>
HWY_INLINE void over_samples(std::size_t count, const Visit& visit) {
  const hn::ScalableTag<Real> d;
  const hn::CappedTag<Real, 8> shorter;
  const hn::CappedTag<Real, 4> short_one;
  const hn::CappedTag<Real, 1> one;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) visit(d, i);
  for (; i + hn::Lanes(shorter) <= count; i += hn::Lanes(shorter)) visit(shorter, i);
  for (; i + hn::Lanes(short_one) <= count; i += hn::Lanes(short_one)) visit(short_one, i);
  for (; i < count; ++i) visit(one, i);
}

/// Calls visit(descriptor, index, distance to the right neighbour); the last sample's neighbour is
/// the first.
template <typename Real, class Visit>
HWY_INLINE void over_row(std::size_t width, const Visit& visit) {
  const std::size_t last = width - 1;
  over_samples<Real>(last, [&](auto d, std::size_t i) HWY_ATTR { visit(d, i, 1); });
  visit(hn::CappedTag<Real, 1>(), last, -static_cast<std::ptrdiff_t>(last));
}

template <typename Real>
void map_row(const AdmmRow<Real>& row, std::size_t width, const AdmmNumbers<Real>& numbers) {
  over_row<Real>(width, [&](auto d, std::size_t i, std::ptrdiff_t right)
                            HWY_ATTR { map_samples(d, row, width, numbers, i, right); });
}

template <typename Real>
void restarted_row(const AdmmRow<Real>& row, std::size_t width,
                   const RestartNumbers<Real>& numbers) {
  over_row<Real>(width, [&](auto d, std::size_t i, std::ptrdiff_t right)
                            HWY_ATTR { restart_samples(d, row, numbers, i, right); });
}

template <typename Real>
void divergence_of_row(const Real* x, const Real* y, const Real* above, std::size_t width,
                       Real* out) {
  const std::size_t last = width - 1;
  out[0] = (x[last] - x[0]) + (above[0] - y[0]);
  over_samples<Real>(last, [&](auto d, std::size_t left) HWY_ATTR {
    const std::size_t i = left + 1;
    const auto along_x = hn::Sub(hn::LoadU(d, x + left), hn::LoadU(d, x + i));
    const auto along_y = hn::Sub(hn::LoadU(d, above + i), hn::LoadU(d, y + i));
    hn::StoreU(hn::Add(along_x, along_y), d, out + i);
  });
}

template <typename Real>
void clipped_row(const Real* x, const Real* y, std::size_t width, Real scale, Real* out_x,
                 Real* out_y) {
  over_row<Real>(width, [&](auto d, std::size_t i, std::ptrdiff_t) HWY_ATTR {
    const auto factor = hn::Set(d, scale);
    const auto from = load(d, x + i, y + i);
    const PairOf<decltype(d)> scaled = {hn::Mul(factor, from.x), hn::Mul(factor, from.y)};
    store(d, clipped(d, scaled, hn::Set(d, Real{1})), out_x + i, out_y + i);
  });
}

/// Samples as double, regardless of how they are stored.
template <class D>
HWY_INLINE hn::Vec<D> load_wide(D d, const float* from) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, D>(), from));
}
template <class D>
HWY_INLINE hn::Vec<D> load_wide(D d, const double* from) {
  return hn::LoadU(d, from);
}

template <class D, typename Real>
HWY_INLINE PairOf<D> wide_gradient(D d, const Real* here, const Real* below, std::ptrdiff_t right) {
  const auto centre = load_wide(d, here);
  return {hn::Sub(load_wide(d, here + right), centre), hn::Sub(load_wide(d, below), centre)};
}

/// Adds as many samples as d has lanes, from i on.
template <class D, typename Real>
HWY_INLINE void add_gap(D d, const GapRow<Real>& row, std::size_t i, std::ptrdiff_t right,
                        hn::Vec<D>& primal, hn::Vec<D>& difference) {
  const auto f = wide_gradient(d, row.image + i, row.image_below + i, right);
  const auto v = wide_gradient(d, row.texture + i, row.texture_below + i, right);
  const PairOf<D> u = {hn::Sub(f.x, v.x), hn::Sub(f.y, v.y)};
  const PairOf<D> q = {load_wide(d, row.q_x + i), load_wide(d, row.q_y + i)};
  const auto steepness = norm(u);
  const auto q_v = hn::MulAdd(q.x, v.x, hn::Mul(q.y, v.y));
  const auto q_u = hn::MulAdd(q.x, u.x, hn::Mul(q.y, u.y));
  primal = hn::Add(primal, hn::MulAdd(hn::Set(d, 0.5), q_v, steepness));
  difference = hn::Add(difference, hn::Max(hn::Sub(steepness, q_u), hn::Zero(d)));
}

template <typename Real>
GapSums gap_of_row(const GapRow<Real>& row, std::size_t width) {
  const hn::ScalableTag<double> d;
  const hn::CappedTag<double, 1> one;
  auto primal = hn::Zero(d), difference = hn::Zero(d);
  auto last_primal = hn::Zero(one), last_difference = hn::Zero(one);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) < width; i += hn::Lanes(d)) add_gap(d, row, i, 1, primal, difference);
  for (; i + 1 < width; ++i) add_gap(one, row, i, 1, last_primal, last_difference);
  add_gap(one, row, i, -static_cast<std::ptrdiff_t>(i), last_primal, last_difference);
  return {hn::GetLane(hn::SumOfLanes(d, primal)) + hn::GetLane(last_primal),
          hn::GetLane(hn::SumOfLanes(d, difference)) + hn::GetLane(last_difference)};
}

// A target exports functions, not templates.
RowKernels<float> kernels_f32() {
  return {map_row<float>, restarted_row<float>, divergence_of_row<float>, clipped_row<float>,
          gap_of_row<float>};
}
RowKernels<double> kernels_f64() {
  return {map_row<double>, restarted_row<double>, divergence_of_row<double>, clipped_row<double>,
          gap_of_row<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {

HWY_EXPORT(kernels_f32);
HWY_EXPORT(kernels_f64);

template <>
RowKernels<float> row_kernels() {
  return HWY_DYNAMIC_DISPATCH(kernels_f32)();
}
template <>
RowKernels<double> row_kernels() {
  return HWY_DYNAMIC_DISPATCH(kernels_f64)();
}

}  // namespace touchtrial::engine
#endif
