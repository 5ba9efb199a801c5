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

/// The gradient at the samples; their right neighbours start at `right`.
template <class D>
HWY_INLINE PairOf<D> gradient(D d, const hn::TFromD<D>* samples, const hn::TFromD<D>* right,
                              const hn::TFromD<D>* samples_below) {
  const auto centre = hn::LoadU(d, samples);
  return {hn::Sub(hn::LoadU(d, right), centre), hn::Sub(hn::LoadU(d, samples_below), centre)};
}

template <class V>
HWY_INLINE V norm(const Pair<V>& pair) {
  return hn::Sqrt(hn::MulAdd(pair.x, pair.x, hn::Mul(pair.y, pair.y)));
}

/// limit / max(|pair|, limit)
template <class D, class V = hn::Vec<D>, hwy::EnableIf<sizeof(hn::TFromD<D>) == 8>* = nullptr>
HWY_INLINE V clip_factor(D, const Pair<V>& pair, V limit) {
  return hn::Div(limit, hn::Max(norm(pair), limit));
}

/// Returns the same to about the last digit: an approximate root and one Newton step take a third
/// of the time of a square root and a division. Exactly 1 within the limit.
template <class D, class V = hn::Vec<D>, hwy::EnableIf<sizeof(hn::TFromD<D>) == 4>* = nullptr>
HWY_INLINE V clip_factor(D d, const Pair<V>& pair, V limit) {
  const V one = hn::Set(d, 1.0F);
  const V squared = hn::MulAdd(pair.x, pair.x, hn::Mul(pair.y, pair.y));
  const V limit_squared = hn::Mul(limit, limit);
  const V safe = hn::Max(squared, limit_squared);
  const V root = hn::ApproximateReciprocalSqrt(safe);
  const V half_root = hn::Mul(hn::Mul(hn::Set(d, 0.5F), safe), root);
  const V share =
      hn::Mul(limit, hn::MulAdd(root, hn::NegMulAdd(half_root, root, hn::Set(d, 0.5F)), root));
  return hn::IfThenElse(hn::Gt(squared, limit_squared), share, one);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Pair<V> clip_pair(D d, const Pair<V>& pair, V limit) {
  const V share = clip_factor(d, pair, limit);
  return {hn::Mul(share, pair.x), hn::Mul(share, pair.y)};
}

template <class V>
HWY_INLINE V target(V image, V z, V b) {
  return hn::Add(hn::Sub(image, z), hn::Add(b, b));
}

/// relaxation * grad u + (1 - relaxation) * w + b, with w = z - b
template <class V>
HWY_INLINE V map_value(V u, V z, V b, V relaxation) {
  const V w = hn::Sub(z, b);
  return hn::Add(hn::MulAdd(relaxation, hn::Sub(u, w), w), b);
}

/// Prefetches the sample below; the transforms between two rows hide the latency.
template <typename Real>
HWY_INLINE void prefetch(const Real* sample, std::size_t width) {
  hwy::Prefetch(sample + width);
}

/// Maps one vector of samples of a row, starting at i; `right` is the offset of the right
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
  const auto b = clip_pair(d, z, limit);
  const PairOf<D> next = {map_value(hn::Sub(f.x, v.x), z.x, b.x, relaxation),
                          map_value(hn::Sub(f.y, v.y), z.y, b.y, relaxation)};
  PairOf<D> extrapolated = next;
  if (numbers.momentum != 0) {
    prefetch(row.previous_x + i, width);
    prefetch(row.previous_y + i, width);
    const auto previous = load(d, row.previous_x + i, row.previous_y + i);
    extrapolated = {hn::MulAdd(momentum, hn::Sub(next.x, previous.x), next.x),
                    hn::MulAdd(momentum, hn::Sub(next.y, previous.y), next.y)};
  }
  if (numbers.store_previous) store(d, next, row.previous_x + i, row.previous_y + i);
  store(d, extrapolated, row.z_x + i, row.z_y + i);
  const auto next_b = clip_pair(d, extrapolated, limit);
  if (numbers.b_only) return store(d, next_b, row.target_x + i, row.target_y + i);
  store(d, PairOf<D>{target(f.x, extrapolated.x, next_b.x), target(f.y, extrapolated.y, next_b.y)},
        row.target_x + i, row.target_y + i);
}

template <class D, typename Real>
HWY_INLINE void restart_samples(D d, const AdmmRow<Real>& row, const RestartNumbers<Real>& numbers,
                                std::size_t i, std::ptrdiff_t right) {
  const auto f = gradient(d, row.image + i, row.image + i + right, row.image_below + i);
  const auto old_z = load(d, row.z_x + i, row.z_y + i);
  const auto old_b = clip_pair(d, old_z, hn::Set(d, numbers.previous_limit));
  const auto ratio = hn::Set(d, numbers.limit / numbers.previous_limit);
  const PairOf<D> b = {hn::Mul(ratio, old_b.x), hn::Mul(ratio, old_b.y)};
  const PairOf<D> z = {hn::Add(hn::Sub(old_z.x, old_b.x), b.x),
                       hn::Add(hn::Sub(old_z.y, old_b.y), b.y)};
  store(d, z, row.z_x + i, row.z_y + i);
  store(d, PairOf<D>{target(f.x, z.x, b.x), target(f.y, z.y, b.y)}, row.target_x + i,
        row.target_y + i);
}

/// Calls visit(descriptor, index) for full vectors, then for shorter ones and single samples.
template <typename Real, class Visit>
HWY_INLINE void for_each_vector(std::size_t count, const Visit& visit) {
  const hn::ScalableTag<Real> d;
  const hn::CappedTag<Real, 8> shorter;
  const hn::CappedTag<Real, 4> shortest;
  const hn::CappedTag<Real, 1> single;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) visit(d, i);
  for (; i + hn::Lanes(shorter) <= count; i += hn::Lanes(shorter)) visit(shorter, i);
  for (; i + hn::Lanes(shortest) <= count; i += hn::Lanes(shortest)) visit(shortest, i);
  for (; i < count; ++i) visit(single, i);
}

/// Calls visit(descriptor, index, distance to the right neighbour); the last sample's neighbour is
/// the first.
template <typename Real, class Visit>
HWY_INLINE void for_each_in_row(std::size_t width, const Visit& visit) {
  const std::size_t last = width - 1;
  for_each_vector<Real>(last, [&](auto d, std::size_t i) HWY_ATTR { visit(d, i, 1); });
  visit(hn::CappedTag<Real, 1>(), last, -static_cast<std::ptrdiff_t>(last));
}

template <typename Real>
void map_row(const AdmmRow<Real>& row, std::size_t width, const AdmmNumbers<Real>& numbers) {
  for_each_in_row<Real>(width, [&](auto d, std::size_t i, std::ptrdiff_t right)
                                   HWY_ATTR { map_samples(d, row, width, numbers, i, right); });
}

template <typename Real>
void restart_row(const AdmmRow<Real>& row, std::size_t width, const RestartNumbers<Real>& numbers) {
  for_each_in_row<Real>(width, [&](auto d, std::size_t i, std::ptrdiff_t right)
                                   HWY_ATTR { restart_samples(d, row, numbers, i, right); });
}

template <typename Real>
void divergence_of_row(const Real* x, const Real* y, const Real* y_above, std::size_t width,
                       Real* out) {
  const std::size_t last = width - 1;
  out[0] = (x[last] - x[0]) + (y_above[0] - y[0]);
  for_each_vector<Real>(last, [&](auto d, std::size_t left) HWY_ATTR {
    const std::size_t i = left + 1;
    const auto along_x = hn::Sub(hn::LoadU(d, x + left), hn::LoadU(d, x + i));
    const auto along_y = hn::Sub(hn::LoadU(d, y_above + i), hn::LoadU(d, y + i));
    hn::StoreU(hn::Add(along_x, along_y), d, out + i);
  });
}

template <typename Real>
void clip_row(const Real* x, const Real* y, std::size_t width, Real scale, Real* out_x,
              Real* out_y) {
  for_each_in_row<Real>(width, [&](auto d, std::size_t i, std::ptrdiff_t) HWY_ATTR {
    const auto factor = hn::Set(d, scale);
    const auto source = load(d, x + i, y + i);
    const PairOf<decltype(d)> scaled = {hn::Mul(factor, source.x), hn::Mul(factor, source.y)};
    store(d, clip_pair(d, scaled, hn::Set(d, Real{1})), out_x + i, out_y + i);
  });
}

/// Loads samples as double from either precision.
template <class D>
HWY_INLINE hn::Vec<D> load_wide(D d, const float* source) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, D>(), source));
}
template <class D>
HWY_INLINE hn::Vec<D> load_wide(D d, const double* source) {
  return hn::LoadU(d, source);
}

template <class D, typename Real>
HWY_INLINE PairOf<D> wide_gradient(D d, const Real* samples, const Real* samples_below,
                                   std::ptrdiff_t right) {
  const auto centre = load_wide(d, samples);
  return {hn::Sub(load_wide(d, samples + right), centre),
          hn::Sub(load_wide(d, samples_below), centre)};
}

/// Adds one vector of samples, starting at i.
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
  const hn::CappedTag<double, 1> single;
  auto primal = hn::Zero(d), difference = hn::Zero(d);
  auto last_primal = hn::Zero(single), last_difference = hn::Zero(single);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) < width; i += hn::Lanes(d)) add_gap(d, row, i, 1, primal, difference);
  for (; i + 1 < width; ++i) add_gap(single, row, i, 1, last_primal, last_difference);
  add_gap(single, row, i, -static_cast<std::ptrdiff_t>(i), last_primal, last_difference);
  return {hn::GetLane(hn::SumOfLanes(d, primal)) + hn::GetLane(last_primal),
          hn::GetLane(hn::SumOfLanes(d, difference)) + hn::GetLane(last_difference)};
}

// A target exports functions, not templates.
RowKernels<float> kernels_f32() {
  return {map_row<float>, restart_row<float>, divergence_of_row<float>, clip_row<float>,
          gap_of_row<float>};
}
RowKernels<double> kernels_f64() {
  return {map_row<double>, restart_row<double>, divergence_of_row<double>, clip_row<double>,
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
