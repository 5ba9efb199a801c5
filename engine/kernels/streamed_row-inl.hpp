/// \file Moves streamed rows, for one target.
// Included once for every target, by files that do the same.
#if defined(TOUCHTRIAL_STREAMED_ROW_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TOUCHTRIAL_STREAMED_ROW_INL
#undef TOUCHTRIAL_STREAMED_ROW_INL
#else
#define TOUCHTRIAL_STREAMED_ROW_INL
#endif

#include "engine/kernels/streamed_row.hpp"

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

/// Moves samples x .. x + length - 1, as far as the row has them.
/// \param x,length  multiples of the number of lanes
HWY_INLINE void move_samples(const StreamedRow& row, int x, int length) {
  const hwy::HWY_NAMESPACE::ScalableTag<float> d;
  const int lanes = static_cast<int>(hwy::HWY_NAMESPACE::Lanes(d));
  for (const int end = x + length; x < end; x += lanes) {
    if (x >= row.count) return;
    hwy::HWY_NAMESPACE::Stream(hwy::HWY_NAMESPACE::LoadU(d, row.from + x), d, row.to + x);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#endif
