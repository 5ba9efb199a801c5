#include "engine/metrics/ssim_kernels.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace touchtrial::engine {
namespace {

/// The two rows of a line of blocks; the same one twice where an odd last row is repeated.
template <typename Sample>
struct RowPair {
  RowPair(const Plane<Sample>& plane, int block_y)
      : upper(plane.row(2 * block_y).data()),
        lower(plane.row(std::min(2 * block_y + 1, plane.height() - 1)).data()) {}

  /// \tparam Sum  holds four samples without loss
  template <typename Sum>
  [[nodiscard]] Sum block(std::size_t left, std::size_t right) const {
    return (Sum{upper[left]} + Sum{upper[right]}) + (Sum{lower[left]} + Sum{lower[right]});
  }

  const Sample* upper;
  const Sample* lower;
};

/// Calls set(block, left column, right column) for a line of blocks across `width` columns.
template <typename Set>
void for_each_block(int width, Set&& set) {
  const auto whole = static_cast<std::size_t>(width / 2);
  for (std::size_t x = 0; x < whole; ++x) set(x, 2 * x, 2 * x + 1);
  if (width % 2 != 0) set(whole, 2 * whole, 2 * whole);
}

template <typename Real>
SumDifference<Real> blocks_of(int height, int width, PairOffsets offsets) {
  const int rows = (height + 1) / 2;
  const int columns = (width + 1) / 2;
  return {Plane<Real>(rows, columns), Plane<Real>(rows, columns), offsets};
}

}  // namespace

template <typename Real>
SumDifference<Real> halved(const GreyPair& pair) {
  const int width = pair.x.width();
  auto result = blocks_of<Real>(pair.x.height(), width, pair.offsets);
  constexpr auto kQuarter = static_cast<Real>(0.25);
  for (int y = 0; y < result.sum.height(); ++y) {
    const RowPair<std::uint8_t> of_x(pair.x, y);
    const RowPair<std::uint8_t> of_y(pair.y, y);
    Real* const sum = result.sum.row(y).data();
    Real* const difference = result.difference.row(y).data();
    for_each_block(width, [&](std::size_t x, std::size_t left, std::size_t right) {
      const auto a = of_x.block<int>(left, right);
      const auto b = of_y.block<int>(left, right);
      sum[x] = kQuarter * static_cast<Real>(a + b - 4 * pair.offsets.sum);
      difference[x] = kQuarter * static_cast<Real>(a - b - 4 * pair.offsets.difference);
    });
  }
  return result;
}

template <typename Real>
SumDifference<Real> halved(const SumDifference<Real>& pair) {
  const int width = pair.sum.width();
  auto result = blocks_of<Real>(pair.sum.height(), width, pair.offsets);
  constexpr auto kQuarter = static_cast<Real>(0.25);
  for (int y = 0; y < result.sum.height(); ++y) {
    const RowPair<Real> of_sum(pair.sum, y);
    const RowPair<Real> of_difference(pair.difference, y);
    Real* const sum = result.sum.row(y).data();
    Real* const difference = result.difference.row(y).data();
    for_each_block(width, [&](std::size_t x, std::size_t left, std::size_t right) {
      sum[x] = kQuarter * of_sum.template block<Real>(left, right);
      difference[x] = kQuarter * of_difference.template block<Real>(left, right);
    });
  }
  return result;
}

template SumDifference<float> halved(const GreyPair&);
template SumDifference<double> halved(const GreyPair&);
template SumDifference<float> halved(const SumDifference<float>&);
template SumDifference<double> halved(const SumDifference<double>&);

}  // namespace touchtrial::engine
