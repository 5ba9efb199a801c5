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

double positive_power(double mean, double weight) {
  return std::pow(std::max(mean, 0.0), weight);
}

/// The last scale is computed in double, because in float an l near 0 would lose its digits.
template <typename Real>
SumDifference<double> to_double(const SumDifference<Real>& pair) {
  return {converted<double>(pair.sum), converted<double>(pair.difference), pair.offsets};
}

/// Multiplies the product by the mean of one scale.
void include_scale(MsSsim& product, std::size_t scale, double mean) {
  product.unit *= mean;
  product.wang *= positive_power(mean, kWangWeights[scale]);
}

/// Two rows of samples that form a row of blocks. An odd last row is used twice.
template <typename Sample>
struct RowPair {
  RowPair(const Plane<Sample>& plane, int block_y)
      : upper(plane.row(2 * block_y).data()),
        lower(plane.row(std::min(2 * block_y + 1, plane.height() - 1)).data()) {}

  /// The sum of a block.
  /// \tparam Sum  represents the sum of four samples exactly
  template <typename Sum>
  [[nodiscard]] Sum block(std::size_t left, std::size_t right) const {
    return (Sum{upper[left]} + Sum{upper[right]}) + (Sum{lower[left]} + Sum{lower[right]});
  }

  const Sample* upper;
  const Sample* lower;
};

/// Calls visit(block, left column, right column) for a row of blocks across `width` columns.
template <typename Visit>
void for_each_block(int width, Visit&& visit) {
  const auto full_blocks = static_cast<std::size_t>(width / 2);
  for (std::size_t x = 0; x < full_blocks; ++x) visit(x, 2 * x, 2 * x + 1);
  if (width % 2 != 0) visit(full_blocks, 2 * full_blocks, 2 * full_blocks);
}

template <typename Real>
SumDifference<Real> empty_blocks(int height, int width, PairOffsets offsets) {
  const int rows = (height + 1) / 2;
  const int columns = (width + 1) / 2;
  return {Plane<Real>(rows, columns), Plane<Real>(rows, columns), offsets};
}

/// The means of blocks of 2 x 2 samples; an odd last row or column is repeated.
template <typename Real>
SumDifference<Real> halve(const GreyPair& pair) {
  const int width = pair.x.width();
  auto result = empty_blocks<Real>(pair.x.height(), width, pair.offsets);
  constexpr auto kQuarter = static_cast<Real>(0.25);
  for (int y = 0; y < result.sum.height(); ++y) {
    const RowPair<std::uint8_t> x_rows(pair.x, y);
    const RowPair<std::uint8_t> y_rows(pair.y, y);
    Real* const sum = result.sum.row(y).data();
    Real* const difference = result.difference.row(y).data();
    for_each_block(width, [&](std::size_t x, std::size_t left, std::size_t right) {
      const auto a = x_rows.block<int>(left, right);
      const auto b = y_rows.block<int>(left, right);
      sum[x] = kQuarter * static_cast<Real>(a + b - 4 * pair.offsets.sum);
      difference[x] = kQuarter * static_cast<Real>(a - b - 4 * pair.offsets.difference);
    });
  }
  return result;
}

template <typename Real>
SumDifference<Real> halve(const SumDifference<Real>& pair) {
  const int width = pair.sum.width();
  auto result = empty_blocks<Real>(pair.sum.height(), width, pair.offsets);
  constexpr auto kQuarter = static_cast<Real>(0.25);
  for (int y = 0; y < result.sum.height(); ++y) {
    const RowPair<Real> sum_rows(pair.sum, y);
    const RowPair<Real> difference_rows(pair.difference, y);
    Real* const sum = result.sum.row(y).data();
    Real* const difference = result.difference.row(y).data();
    for_each_block(width, [&](std::size_t x, std::size_t left, std::size_t right) {
      sum[x] = kQuarter * sum_rows.template block<Real>(left, right);
      difference[x] = kQuarter * difference_rows.template block<Real>(left, right);
    });
  }
  return result;
}

}  // namespace

// Ties are rounded away from zero: swapping the images only changes the sign of the difference.
GreyPair centred_pair(const GreyImage& x, const GreyImage& y) {
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
  constexpr std::size_t kLastScale = kWangWeights.size() - 1;
  const GreyPair pair = centred_pair(a, b);
  MsSsim product{1.0, 1.0};
  include_scale(product, 0, 1.0 - mean_deficits<Real>(pair, Luminance::skip).structure);
  SumDifference<Real> smaller_pair = halve<Real>(pair);
  for (std::size_t scale = 1; scale < kLastScale; ++scale) {
    include_scale(product, scale, 1.0 - mean_deficits(smaller_pair, Luminance::skip).structure);
    smaller_pair = halve(smaller_pair);
  }
  const MeanDeficits last_deficits = mean_deficits(to_double(smaller_pair), Luminance::include);
  include_scale(product, kLastScale, 1.0 - last_deficits.structure);
  include_scale(product, kLastScale, 1.0 - last_deficits.luminance);
  return product;
}

template MsSsim ms_ssim<float>(const GreyImage&, const GreyImage&);
template MsSsim ms_ssim<double>(const GreyImage&, const GreyImage&);

}  // namespace touchtrial::engine
