#include "engine/metrics/ssim.hpp"

#include "engine/metrics/ssim_kernels.hpp"

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

void check(const std::string& function, const GreyImage& a, const GreyImage& b, int smallest_side) {
  if (a.height() != b.height() || a.width() != b.width()) {
    throw std::invalid_argument(function + ": the images differ in size, " + size_of(a) + " and " +
                                size_of(b) + " pixels");
  }
  if (std::min(a.height(), a.width()) < smallest_side) {
    throw std::invalid_argument(function + ": the images are " + size_of(a) +
                                " pixels, and both sides must be at least " +
                                std::to_string(smallest_side));
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

/// The means of sum and difference, rounded away from zero at a tie: swapping the images changes
/// nothing but the sign of the difference.
GreyPair centred(const GreyImage& a, const GreyImage& b) {
  const auto pixels = static_cast<double>(a.size());
  const std::int64_t total_a = total_of(a);
  const std::int64_t total_b = total_of(b);
  const PairOffsets offsets{
      static_cast<int>(std::lround(static_cast<double>(total_a + total_b) / pixels)),
      static_cast<int>(std::lround(static_cast<double>(total_a - total_b) / pixels))};
  return {a, b, offsets};
}

double weighted(double mean, double weight) {
  return std::pow(std::max(mean, 0.0), weight);
}

/// For the last scale, which is small: floats would lose the digits of an l near 0.
template <typename Real>
SumDifference<double> in_double(const SumDifference<Real>& pair) {
  return {converted<double>(pair.sum), converted<double>(pair.difference), pair.offsets};
}

/// Multiplies the figures of one scale into the product.
void include_scale(MsSsim& product, std::size_t scale, double mean) {
  product.unit *= mean;
  product.wang *= weighted(mean, kWangWeights[scale]);
}

}  // namespace

template <typename Real>
double ssim(const GreyImage& a, const GreyImage& b) {
  check("ssim", a, b, kSsimSmallestSide);
  return 1.0 - mean_deficits<Real>(centred(a, b), Luminance::include).similarity;
}

template <typename Real>
MsSsim ms_ssim(const GreyImage& a, const GreyImage& b) {
  check("ms_ssim", a, b, kMsSsimSmallestSide);
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

template double ssim<float>(const GreyImage&, const GreyImage&);
template double ssim<double>(const GreyImage&, const GreyImage&);
template MsSsim ms_ssim<float>(const GreyImage&, const GreyImage&);
template MsSsim ms_ssim<double>(const GreyImage&, const GreyImage&);

}  // namespace touchtrial::engine
