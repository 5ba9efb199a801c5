#include "engine/kernels/extended_rows.hpp"

#include "engine/symmetric_extension.hpp"

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/extended_rows.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next one is compiled for the target that those two have set.
#include "engine/kernels/real_pairs-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

void widened(const std::uint8_t* from, int width, std::int16_t* to) {
  int x = 0;
  for (; x + kBlock <= width; x += kBlock) hn::StoreU(load_bytes(from + x), Integers(), to + x);
  for (; x < width; ++x) to[x] = from[x];
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(widened);

}  // namespace

ExtendedRows::ExtendedRows(const GreyImage& image, int reach)
    : image_(image),
      reach_(reach),
      rows_(2 * static_cast<std::size_t>(reach) + 1, static_cast<std::size_t>(image.width()),
            static_cast<std::size_t>(reach)) {
  for (int y = -reach; y < reach; ++y) load(y);
}

void ExtendedRows::next_row() {
  ++y_;
  load(y_ + reach_);
}

void ExtendedRows::load(int y) {
  const int width = image_.width();
  std::int16_t* const to = rows_.row(slot(y));
  HWY_DYNAMIC_DISPATCH(widened)
  (image_.row(symmetric_index(y, image_.height())).data(), width, to);
  for (int i = 1; i <= reach_; ++i) {
    to[-i] = to[symmetric_index(-i, width)];
    to[width - 1 + i] = to[symmetric_index(width - 1 + i, width)];
  }
}

}  // namespace touchtrial::engine
#endif
