#include "engine/kernels/gl_row.hpp"

#include "engine/kernels/rows_ahead.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/gl_row.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next header is compiled for the target selected above.
#include "engine/kernels/real_pairs-inl.hpp"
// clang-format on

#ifndef TOUCHTRIAL_GL_ROW_ONCE
#define TOUCHTRIAL_GL_ROW_ONCE
namespace touchtrial::engine {
namespace {

/// The number of columns processed at a time. With the usual radii their data stay in the
/// first-level cache.
constexpr int kTile = 512;
constexpr int kSlack = static_cast<int>(kVectorBytes / sizeof(std::int16_t));
constexpr int kFront = 64;
constexpr int kColumns = kFront + kTile + kMaxGlRadius + 1 + kSlack;
static_assert(kFront > kMaxGlRadius);

/// The column sums of one tile. Entry kFront + i of a ring belongs to column x0 + i. Only the
/// entries that the radius needs are touched.
struct Workspace {
  alignas(64) std::int16_t sums[kMaxGlRadius][kColumns];
};

struct Tile {
  int x0;
  int width;
};

/// a_{k+1} = lead[k] - v * share[k].
struct DecayTable {
  std::array<float, kMaxGlRadius + 1> lead{};
  std::array<float, kMaxGlRadius + 1> share{};
};

constexpr DecayTable decay_table() {
  DecayTable table;
  for (int k = 1; k <= kMaxGlRadius; ++k) {
    table.lead[k] = static_cast<float>(static_cast<double>(k) / (k + 1));
    table.share[k] = static_cast<float>(1.0 / (k + 1));
  }
  return table;
}

constexpr DecayTable kDecays = decay_table();

/// The factors of one order for all pixels, each rounded once from double.
struct FixedFactors {
  FixedFactors(double order, int radius) : gain(static_cast<float>(order / 8)) {
    for (int k = 1; k < radius; ++k) decays[k] = static_cast<float>((k - order) / (k + 1));
  }
  float gain;
  std::array<float, kMaxGlRadius + 1> decays{};
};

}  // namespace
}  // namespace touchtrial::engine
#endif

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

/// Converts a row of bytes to 16-bit integers.
void widen(const std::uint8_t* source, int width, std::int16_t* target) {
  int x = 0;
  for (; x + kBlock <= width; x += kBlock)
    hn::StoreU(load_bytes(source + x), Integers(), target + x);
  for (; x < width; ++x) target[x] = source[x];
}

/// Applies the factors of each pixel's order.
class PixelOrders {
 public:
  explicit PixelOrders(const float* orders) : orders_(orders) {}
  HWY_INLINE RealPair at(int x) const { return load_pair(orders_ + x); }
  static HWY_INLINE RealPair step(RealPair order, int k, RealPair ring, RealPair inner) {
    const auto lead = hn::Set(Reals(), kDecays.lead[k]);
    const auto share = hn::Set(Reals(), kDecays.share[k]);
    return {hn::MulAdd(hn::NegMulAdd(order.lower, share, lead), inner.lower, ring.lower),
            hn::MulAdd(hn::NegMulAdd(order.upper, share, lead), inner.upper, ring.upper)};
  }
  static HWY_INLINE RealPair finish(RealPair order, RealPair sum) {
    const auto eighth = hn::Set(Reals(), 0.125F);  // a ring has eight samples
    return {hn::Mul(hn::Mul(order.lower, eighth), sum.lower),
            hn::Mul(hn::Mul(order.upper, eighth), sum.upper)};
  }

 private:
  const float* orders_;
};

/// Applies the factors of one order for all pixels.
class SharedOrder {
 public:
  explicit SharedOrder(const FixedFactors& factors) : factors_(factors) {}
  struct NoOrder {};
  static HWY_INLINE NoOrder at(int) { return {}; }
  HWY_INLINE RealPair step(NoOrder, int k, RealPair ring, RealPair inner) const {
    const auto decay = hn::Set(Reals(), factors_.decays[k]);
    return {hn::MulAdd(decay, inner.lower, ring.lower), hn::MulAdd(decay, inner.upper, ring.upper)};
  }
  HWY_INLINE RealPair finish(NoOrder, RealPair sum) const {
    const auto gain = hn::Set(Reals(), factors_.gain);
    return {hn::Mul(gain, sum.lower), hn::Mul(gain, sum.upper)};
  }

 private:
  const FixedFactors& factors_;
};

/// The first column sum of a ring, a multiple of kBlock columns before the tile.
constexpr int first_block(int k) {
  return -(k + kBlock - 1) / kBlock * kBlock;
}

HWY_INLINE void sum_columns(const ExtendedRows& rows, int k, Tile tile, Workspace& work) {
  const Integers d;
  const std::int16_t* const above = rows.row(-k) + tile.x0;
  const std::int16_t* const centre = rows.row(0) + tile.x0;
  const std::int16_t* const below = rows.row(k) + tile.x0;
  std::int16_t* const sums = work.sums[k - 1] + kFront;
  for (int i = first_block(k); i < tile.width + k; i += kBlock) {
    const auto wings = hn::Add(hn::Load(d, above + i), hn::Load(d, below + i));
    hn::Store(hn::Add(wings, hn::Load(d, centre + i)), d, sums + i);
  }
}

/// The column sums of both rings of radius 2. Loads the centre only once.
HWY_INLINE void sum_columns_radius_2(const ExtendedRows& rows, Tile tile, Workspace& work) {
  const Integers d;
  const std::array<const std::int16_t*, 5> source = {rows.row(-2) + tile.x0, rows.row(-1) + tile.x0,
                                                     rows.row(0) + tile.x0, rows.row(1) + tile.x0,
                                                     rows.row(2) + tile.x0};
  std::int16_t* const inner = work.sums[0] + kFront;
  std::int16_t* const outer = work.sums[1] + kFront;
  for (int i = first_block(2); i < tile.width + 2; i += kBlock) {
    const auto centre = hn::Load(d, source[2] + i);
    const auto near_wings = hn::Add(hn::Load(d, source[1] + i), hn::Load(d, source[3] + i));
    const auto far_wings = hn::Add(hn::Load(d, source[0] + i), hn::Load(d, source[4] + i));
    hn::Store(hn::Add(near_wings, centre), d, inner + i);
    hn::Store(hn::Add(far_wings, centre), d, outer + i);
  }
}

/// 8 D_k of a block.
HWY_INLINE RealPair ring_difference(const Workspace& work, int k, int i, Integer nine_centre) {
  const Integers d;
  const std::int16_t* const sums = work.sums[k - 1] + kFront + i;
  const auto sides = hn::Add(hn::LoadU(d, sums - k), hn::LoadU(d, sums + k));
  return to_reals(hn::Sub(hn::Sub(nine_centre, hn::Load(d, sums)), sides));
}

/// The texture of a block, from the outermost ring inwards.
/// \tparam kRadius  the radius if it is known at compile time, else 0
template <int kRadius, class Orders>
HWY_INLINE RealPair texture_block(const Workspace& work, const std::int16_t* centres,
                                  int runtime_radius, int x0, int i, const Orders& orders) {
  const int radius = kRadius == 0 ? runtime_radius : kRadius;
  const auto centre = hn::Load(Integers(), centres + x0 + i);
  const auto nine_centre = hn::Add(hn::ShiftLeft<3>(centre), centre);
  const auto order = orders.at(x0 + i);
  RealPair sum = ring_difference(work, radius, i, nine_centre);
  for (int k = radius - 1; k >= 1; --k) {
    sum = orders.step(order, k, ring_difference(work, k, i, nine_centre), sum);
  }
  return orders.finish(order, sum);
}

template <int kRadius, class Orders>
HWY_INLINE void texture_tile(const Workspace& work, const std::int16_t* centres, int radius,
                             Tile tile, const Orders& orders, float* texture) {
  int i = 0;
  for (; i + kBlock <= tile.width; i += kBlock) {
    store_pair(texture_block<kRadius>(work, centres, radius, tile.x0, i, orders),
               texture + tile.x0 + i);
  }
  if (i == tile.width) return;
  alignas(64) float last_block[kBlock];
  store_pair(texture_block<kRadius>(work, centres, radius, tile.x0, i, orders), last_block);
  std::copy_n(last_block, tile.width - i, texture + tile.x0 + i);
}

template <class Orders>
HWY_INLINE void texture_row(const ExtendedRows& rows, int radius, const Orders& orders,
                            float* texture) {
  Workspace work;
  for (int x0 = 0; x0 < rows.width(); x0 += kTile) {
    const Tile tile{x0, std::min(kTile, rows.width() - x0)};
    if (radius == 2) {  // specialised for the usual radius
      sum_columns_radius_2(rows, tile, work);
      texture_tile<2>(work, rows.row(0), radius, tile, orders, texture);
    } else {
      for (int k = 1; k <= radius; ++k) sum_columns(rows, k, tile, work);
      texture_tile<0>(work, rows.row(0), radius, tile, orders, texture);
    }
  }
}

void row_with_orders(const ExtendedRows& rows, int radius, const float* orders, float* texture) {
  texture_row(rows, radius, PixelOrders(orders), texture);
}

void row_with_shared_order(const ExtendedRows& rows, int radius, const FixedFactors& factors,
                           float* texture) {
  texture_row(rows, radius, SharedOrder(factors), texture);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(widen);
HWY_EXPORT(row_with_orders);
HWY_EXPORT(row_with_shared_order);

}  // namespace

ExtendedRows::ExtendedRows(const GreyImage& image, int reach, int first_row, Columns tile)
    : image_(image),
      tile_(tile),
      reach_(reach),
      y_(first_row - 1),
      rows_(2 * static_cast<std::size_t>(reach) + 1, static_cast<std::size_t>(tile.count()),
            static_cast<std::size_t>(reach)) {
  // The current row is the one before the first, so the row at -reach is not needed.
  for (int offset = 1 - reach; offset <= reach; ++offset) load(offset);
}

void ExtendedRows::next_row() {
  ++y_;
  current_ = current_ == 2 * reach_ ? 0 : current_ + 1;
  load(reach_);
}

void ExtendedRows::load(int offset) {
  const int y = y_ + offset;
  const int width = image_.width();
  const Columns image_columns = {std::max(tile_.first - reach_, 0),
                                 std::min(tile_.last + reach_, width)};
  prefetch_row(image_, y + 1, image_columns);
  std::int16_t* const target = rows_.row(slot(offset)) - tile_.first;  // column 0
  HWY_DYNAMIC_DISPATCH(widen)
  (image_.row(symmetric_index(y, image_.height())).data() + image_columns.first,
   image_columns.count(), target + image_columns.first);
  for (int x = tile_.first - reach_; x < image_columns.first; ++x)
    target[x] = target[symmetric_index(x, width)];
  for (int x = image_columns.last; x < tile_.last + reach_; ++x)
    target[x] = target[symmetric_index(x, width)];
}

void gl_row(const ExtendedRows& rows, int radius, const float* orders, float* texture) {
  HWY_DYNAMIC_DISPATCH(row_with_orders)(rows, radius, orders, texture);
}

void gl_row(const ExtendedRows& rows, int radius, double order, float* texture) {
  HWY_DYNAMIC_DISPATCH(row_with_shared_order)
  (rows, radius, FixedFactors(order, radius), texture);
}

}  // namespace touchtrial::engine
#endif
