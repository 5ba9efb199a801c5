#include "engine/kernels/half_gradient.hpp"

#include "engine/order_map.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/half_gradient.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next one is compiled for the target that those two have set.
#include "engine/kernels/real_pairs-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

/// The squared length of a band's gradient, before kWaveletScale.
HWY_INLINE Real squared_gradient(const SobelRows& rows, std::size_t band, int i) {
  const WideIntegers d;
  const Reals reals;
  const std::int32_t* const smoothed = rows.smoothed[band] + i;
  const std::int32_t* const difference = rows.difference[band] + i;
  const auto across = hn::Sub(hn::LoadU(d, smoothed + 1), hn::LoadU(d, smoothed - 1));
  const auto centre = hn::LoadU(d, difference);
  const auto sides = hn::Add(hn::LoadU(d, difference - 1), hn::LoadU(d, difference + 1));
  const auto x = hn::ConvertTo(reals, across);
  const auto y = hn::ConvertTo(reals, hn::Add(sides, hn::Add(centre, centre)));
  return hn::MulAdd(x, x, hn::Mul(y, y));
}

/// Adds the square root of v. With long vectors the root is the processor's estimate to 14 bits,
/// corrected by one step with the exact remainder: the same to the last bit or nearly,
/// and exact for a square.
HWY_INLINE Real add_estimated_root(Real v, Real sum) {
#if HWY_TARGET <= HWY_AVX3
  const Reals d;
  const auto inverse = hn::ApproximateReciprocalSqrt(hn::Max(v, hn::Set(d, 1e-30F)));
  const auto estimate = hn::Mul(v, inverse);
  const auto remainder = hn::NegMulAdd(estimate, estimate, v);
  return hn::Add(sum, hn::MulAdd(hn::Mul(remainder, hn::Set(d, 0.5F)), inverse, estimate));
#else
  return hn::Add(sum, hn::Sqrt(v));  // the estimate of shorter vectors is too coarse
#endif
}

/// Computes half of the roots in the slow unit for square roots, which works beside the other
/// units.
HWY_INLINE Real csgv_block(const SobelRows& rows, int i) {
  auto sum = hn::Sqrt(squared_gradient(rows, 0, i));
  sum = add_estimated_root(squared_gradient(rows, 1, i), sum);
  sum = hn::Add(sum, hn::Sqrt(squared_gradient(rows, 2, i)));
  sum = add_estimated_root(squared_gradient(rows, 3, i), sum);
  return hn::Mul(sum, hn::Set(Reals(), kWaveletScale));
}

/// One row of CSGV.
/// \param rows  `smoothed` and `difference` have a mirrored sample, or more of the image, at both
///   ends
/// \param first  the column of the rows at which the result begins
/// \param csgv  receives `count` samples; a vector behind them may be overwritten
/// \return the largest of the samples
float row_of_csgv(const SobelRows rows, int first, int count, float* csgv) {
  const Reals d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto largest = hn::Zero(d);
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto block = csgv_block(rows, first + i);
    hn::StoreU(block, d, csgv + i);
    largest = hn::Max(largest, block);
  }
  float of_row = hn::GetLane(hn::MaxOfLanes(d, largest));
  if (i < count) {
    hn::StoreU(csgv_block(rows, first + i), d, csgv + i);
    of_row = std::max(of_row, *std::max_element(csgv + i, csgv + count));
  }
  return of_row;
}

/// Each lane twice, in the same order.
HWY_INLINE RealPair doubled(Real v) {
#if HWY_TARGET == HWY_SCALAR
  return {v, v};
#else
  const Reals d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  alignas(64) std::int32_t places[2 * kLanes];
  for (std::size_t i = 0; i < 2 * kLanes; ++i) places[i] = static_cast<std::int32_t>(i / 2);
  return {hn::TableLookupLanes(v, hn::SetTableIndices(d, places)),
          hn::TableLookupLanes(v, hn::SetTableIndices(d, places + kLanes))};
#endif
}

void row_of_orders(const float* csgv, int count, float largest, float* out) {
  const Reals d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto middle_slope = hn::Set(d, 1.0F / (3.0F * largest));
  const auto steep_slope = hn::Set(d, 1.0F / (2.0F * largest));
  const auto middle_base = hn::Set(d, 0.666F);
  const auto steep_base = hn::Set(d, 0.499F);
  const auto flat_below = hn::Set(d, static_cast<float>(kFlatBelowCsgv));
  const auto steep_above = hn::Set(d, static_cast<float>(kSteepAboveCsgv));
  for (int i = 0; i < count; i += lanes) {
    const auto v = hn::LoadU(d, csgv + i);
    const auto middle = hn::MulAdd(v, middle_slope, middle_base);
    const auto steep = hn::MulAdd(v, steep_slope, steep_base);
    const auto order = hn::IfThenElse(hn::Gt(v, steep_above), steep, middle);
    const RealPair twice = doubled(hn::IfThenElseZero(hn::Ge(v, flat_below), order));
    hn::StoreU(twice.lower, d, out + 2 * i);
    hn::StoreU(twice.upper, d, out + 2 * i + lanes);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(row_of_csgv);
HWY_EXPORT(row_of_orders);

/// The image is processed in strips of columns, so that the rolling rows stay in the first-level
/// cache.
constexpr int kStripColumns = 512;

constexpr std::size_t kVectorSamples = kVectorBytes / sizeof(std::int32_t);

/// The rolling rows of one strip of columns.
class SobelState {
 public:
  explicit SobelState(int columns)
      : samples_(16, static_cast<std::size_t>(columns), kVectorSamples) {
    std::size_t next = 0;
    for (auto* kind : {&rows_.last_but_one, &rows_.last, &rows_.smoothed, &rows_.difference}) {
      for (std::int32_t*& row : *kind) row = samples_.row(next++);
    }
  }

  [[nodiscard]] SobelRows& rows() noexcept { return rows_; }

  /// Mirrors one sample at both ends of the rows from which the gradient is computed.
  void extend(int columns) const {
    for (const auto& bands : {rows_.smoothed, rows_.difference}) {
      for (std::int32_t* const row : bands) mirror_ends(row, columns, 1);
    }
  }

 private:
  AlignedRows<std::int32_t> samples_;
  SobelRows rows_;
};

}  // namespace

HalfGradient::HalfGradient(const GreyImage& image)
    : height_((image.height() + 1) / 2),
      width_((image.width() + 1) / 2),
      rows_(static_cast<std::size_t>(height_), static_cast<std::size_t>(width_), 0, RowUse::plane) {
  const int strips = (width_ + kStripColumns - 1) / kStripColumns;
  std::mutex mutex;
  for_each_strip(height_, 4 * width_, [&](Rows rows) {
    float largest = 0.0F;
    int first = 0;
    for (int strip = 1; strip <= strips; ++strip) {
      const int last = strip == strips ? width_ : first + width_ / strips;
      largest = std::max(largest, compute(image, {first, last}, rows));
      first = last;
    }
    const std::lock_guard lock(mutex);
    largest_ = std::max(largest_, largest);
  });
}

float HalfGradient::compute(const GreyImage& image, Columns columns, Rows rows) {
  const Columns wider{std::max(columns.first - 1, 0), std::min(columns.last + 1, width_)};
  ColumnFilter filter(image, wider);
  SobelState state(wider.count());
  float largest = 0.0F;
  for (int y = rows.first - 1; y <= rows.last; ++y) {
    filter_along_x(filter.row(symmetric_index(y, height_)), wider.count(), state.rows());
    if (y < rows.first + 1) continue;
    state.extend(wider.count());
    float* const to = rows_.row(static_cast<std::size_t>(y - 1)) + columns.first;
    const float largest_of_row = HWY_DYNAMIC_DISPATCH(row_of_csgv)(
        state.rows(), columns.first - wider.first, columns.count(), to);
    largest = std::max(largest, largest_of_row);
  }
  return largest;
}

void order_row(const float* csgv, int count, float largest, float* out) {
  HWY_DYNAMIC_DISPATCH(row_of_orders)(csgv, count, largest, out);
}

}  // namespace touchtrial::engine
#endif
