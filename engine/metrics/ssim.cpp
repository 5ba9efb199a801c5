#include "engine/metrics/ssim.hpp"

#include "engine/metrics/ssim_deficits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>

namespace touchtrial::engine {
namespace {

constexpr std::array<double, 5> kWangWeights = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

std::string size_of(const GreyImage& image) {
  return std::to_string(image.height()) + " x " + std::to_string(image.width());
}

void check_sizes(const GreyImage& a, const GreyImage& b) {
  if (a.height() != b.height() || a.width() != b.width()) {
    throw std::invalid_argument("ms_ssim: the images differ in size, " + size_of(a) + " and " +
                                size_of(b) + " pixels");
  }
  if (std::min(a.height(), a.width()) < kMsSsimSmallestSide) {
    throw std::invalid_argument("ms_ssim: the images are " + size_of(a) +
                                " pixels, and both sides must be at least " +
                                std::to_string(kMsSsimSmallestSide));
  }
}

std::int64_t total_of(const GreyImage& image) {
  std::int64_t total = 0;
  for (int y = 0; y < image.height(); ++y) {
    const auto row = image.row(y);
    total += std::accumulate(row.begin(), row.end(), std::uint32_t{0});
  }
  return total;
}

double weighted(double mean, double weight) {
  return std::pow(std::max(mean, 0.0), weight);
}

/// For the last scale, which is small: in float, an l near 0 would lose its digits.
template <typename Real>
SumDifference<double> in_double(const SumDifference<Real>& pair) {
  return {converted<double>(pair.sum), converted<double>(pair.difference), pair.offsets};
}

/// Multiplies the product by the mean of one scale.
void include_scale(MsSsim& product, std::size_t scale, double mean) {
  product.unit *= mean;
  product.wang *= weighted(mean, kWangWeights[scale]);
}

/// The two rows of a line of blocks. An odd last row is used twice.
template <typename Sample>
struct RowPair {
  RowPair(const Plane<Sample>& plane, int block_y)
      : upper(plane.row(2 * block_y).data()),
        lower(plane.row(std::min(2 * block_y + 1, plane.height() - 1)).data()) {}

  /// The sum of a block.
  /// \tparam Sum  represents the sum of four samples without loss
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

/// The means of blocks of 2 x 2 samples; an odd last row or column is repeated.
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

}  // namespace

// Ties are rounded away from zero: swapping the images only changes the sign of the difference.
GreyPair centred(const GreyImage& x, const GreyImage& y) {
  const auto pixels = static_cast<double>(x.size());
  const std::int64_t total_x = total_of(x);
  const std::int64_t total_y = total_of(y);
  const PairOffsets offsets{
      static_cast<int>(std::lround(static_cast<double>(total_x + total_y) / pixels)),
      static_cast<int>(std::lround(static_cast<double>(total_x - total_y) / pixels))};
  return {x, y, offsets};
}

template <typename Real>
MsSsim ms_ssim(const GreyImage& a, const GreyImage& b) {
  check_sizes(a, b);
  constexpr std::size_t kLast = kWangWeights.size() - 1;
  const GreyPair pair = centred(a, b);
  MsSsim product{1.0, 1.0};
  include_scale(product, 0, 1.0 - mean_deficits<Real>(pair, Luminance::skip).structure);
  SumDifference<Real> scaled = halved<Real>(pair);
  for (std::size_t scale = 1; scale < kLast; ++scale) {
    include_scale(product, scale, 1.0 - mean_deficits(scaled, Luminance::skip).structure);
    scaled = halved(scaled);
  }
  const MeanDeficits last = mean_deficits(in_double(scaled), Luminance::include);
  include_scale(product, kLast, 1.0 - last.structure);
  include_scale(product, kLast, 1.0 - last.luminance);
  return product;
}

template MsSsim ms_ssim<float>(const GreyImage&, const GreyImage&);
template MsSsim ms_ssim<double>(const GreyImage&, const GreyImage&);

}  // namespace touchtrial::engine
