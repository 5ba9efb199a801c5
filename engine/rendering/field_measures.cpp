#include "engine/rendering/field_measures.hpp"

#include "engine/fourier/real_fft.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

/// A 99th percentile below this share of the maximum comes from filter residues.
constexpr double kMinShareOfMaximum = 1e-3;
constexpr double kRadiusTolerance = 1e-9;  // relative

constexpr double square(double value) noexcept {
  return value * value;
}

/// Root mean square over all samples.
template <typename SquareOf>
double root_mean_square(SampledView field, SquareOf square_of) noexcept {
  if (field.samples.empty()) return 0.0;
  double sum = 0.0;
  for (const FieldSample& sample : field.samples) sum += square_of(sample);
  return std::sqrt(sum / static_cast<double>(field.samples.size()));
}

/// Scale * sqrt(squares_at(pixel, width)) / (2 pitch) for every pixel with four neighbours.
template <typename SquaresAt>
std::vector<float> interior_norms(SampledView field, double scale, SquaresAt squares_at) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  if (height < 3 || width < 3) return {};
  const double per_mm = scale / (2.0 * field.geometry.pitch_mm);
  std::vector<float> norms(static_cast<std::size_t>(height - 2) *
                           static_cast<std::size_t>(width - 2));
  float* output = norms.data();
  for (int y = 1; y < height - 1; ++y) {
    const FieldSample* row = field.samples.data() + static_cast<std::size_t>(y) * width;
    for (int x = 1; x < width - 1; ++x) {
      *output++ = static_cast<float>(per_mm * std::sqrt(squares_at(row + x, width)));
    }
  }
  return norms;
}

/// interior_norms() of squared_step(left, right) + squared_step(above, below).
template <typename SquaredStep>
std::vector<float> central_differences(SampledView field, double scale, SquaredStep squared_step) {
  return interior_norms(field, scale, [=](const FieldSample* pixel, int width) {
    return squared_step(pixel[-1], pixel[1]) + squared_step(pixel[-width], pixel[width]);
  });
}

/// Let J be the Jacobian of the full F_T, and P the outer product of F_T and the gradient of the
/// ramp's factor s. The force on the ramp has the Jacobian s J + P along the plane and F_T * per_mm
/// in depth. Its norm is convex in s, so it is largest at an end of the ramp. Above the ramp it is
/// the norm of J.
std::vector<float> stiffness_on_ramp(SampledView field, double scale, RampSlopes ramp) {
  const double per_step = 2.0 * field.geometry.pitch_mm * ramp.per_mm;
  return interior_norms(field, scale, [=](const FieldSample* pixel, int width) {
    double above_ramp = 0.0;
    double at_top = 0.0;
    double at_touchdown = 0.0;
    for (const int step : {1, width}) {
      const FieldSample& lower = pixel[-step];
      const FieldSample& upper = pixel[step];
      const double share = ramp.per_grey * (double{upper.height} - lower.height);
      const double steps[] = {double{upper.force_x} - lower.force_x,
                              double{upper.force_y} - lower.force_y};
      const double shares[] = {share * pixel->force_x, share * pixel->force_y};
      for (const int i : {0, 1}) {
        above_ramp += square(steps[i]);
        at_top += square(steps[i] + shares[i]);
        at_touchdown += square(shares[i]);
      }
    }
    const double in_depth = square(per_step * pixel->force_x) + square(per_step * pixel->force_y);
    return std::max(above_ramp, std::max(at_top, at_touchdown) + in_depth);
  });
}

/// The bucket of a value >= 0 by its leading bits: floats sort like their bits.
constexpr int kBucketBits = 12;
std::size_t bucket_of(float value) noexcept {
  return std::bit_cast<std::uint32_t>(value) >> (32 - kBucketBits);
}

/// Mean of the nonzero values; 0 if there are none.
double mean_of_nonzero(std::span<const double> values) {
  const auto zeros = std::ranges::count(values, 0.0);
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum == 0.0 ? 0.0 : sum / static_cast<double>(std::ssize(values) - zeros);
}

/// Transforms one component of the force minus its mean.
void transform(SampledView field, float FieldSample::*component, RealFft<double>& fft) {
  double sum = 0.0;
  for (const FieldSample& sample : field.samples) sum += double{sample.*component};
  const double mean = sum / static_cast<double>(field.samples.size());
  std::ranges::transform(field.samples, fft.plane().begin(), [=](const FieldSample& sample) {
    return double{sample.*component} - mean;
  });
  fft.forward();
}

/// The first column in a row of the half spectrum with a radial frequency above a limit, or the
/// number of columns. All later columns are above the limit as well.
int first_column_above(double limit_cycles_per_px, double fy, int width) {
  const double limit = limit_cycles_per_px * (1.0 + kRadiusTolerance);
  const auto is_above = [=](int column) {
    const double fx = static_cast<double>(column) / width;
    return std::sqrt(fx * fx + fy * fy) > limit;
  };
  const int columns = width / 2 + 1;
  const double fx_limit = std::sqrt(std::max(0.0, limit * limit - fy * fy));
  int first = static_cast<int>(std::min(fx_limit * width, static_cast<double>(columns)));
  while (first > 0 && is_above(first - 1)) --first;
  while (first < columns && !is_above(first)) ++first;
  return first;
}

}  // namespace

double tangential_rms(SampledView field) noexcept {
  return root_mean_square(
      field, [](const FieldSample& s) { return square(s.force_x) + square(s.force_y); });
}

double height_rms(SampledView field) noexcept {
  return root_mean_square(field, [](const FieldSample& s) { return square(s.height); });
}

std::vector<float> tangential_stiffness(SampledView field, double scale, RampSlopes ramp) {
  if (ramp.per_mm != 0.0) return stiffness_on_ramp(field, scale, ramp);
  return central_differences(field, scale, [](const FieldSample& a, const FieldSample& b) {
    return square(double{b.force_x} - a.force_x) + square(double{b.force_y} - a.force_y);
  });
}

std::vector<float> height_stiffness(SampledView field, double scale) {
  return central_differences(field, scale, [](const FieldSample& a, const FieldSample& b) {
    return square(double{b.height} - a.height);
  });
}

std::vector<double> equalising_factors(std::span<const double> rms, Equalise equalise) {
  std::vector<double> factors;
  for (const double value : rms) {
    if (!std::isfinite(value)) {
      throw std::invalid_argument("choose_gains: a field has samples that are not finite");
    }
    const double equalising = value > 0.0 ? 1.0 / value : 0.0;
    factors.push_back(equalise == Equalise::rms ? equalising : 1.0);
  }
  return factors;
}

double explicit_factor(double gain, std::span<const double> rms, Equalise equalise) {
  return gain * (equalise == Equalise::rms ? mean_of_nonzero(rms) : 1.0);
}

double typical_stiffness(std::span<const std::vector<float>> pools) {
  const double typical = percentile(pools, 0.99);
  float max = 0.0F;
  for (const std::vector<float>& pool : pools) {
    for (const float stiffness : pool) max = std::max(max, stiffness);
  }
  return typical > kMinShareOfMaximum * max ? typical : max;
}

double percentile(std::span<const std::vector<float>> pools, double share) {
  std::vector<std::size_t> counts(std::size_t{1} << kBucketBits);
  std::size_t size = 0;
  for (const std::vector<float>& pool : pools) {
    for (const float value : pool) ++counts[bucket_of(value)];
    size += pool.size();
  }
  if (size == 0) return 0.0;
  const double position = share * static_cast<double>(size - 1);
  const auto rank = static_cast<std::size_t>(position);
  std::size_t bucket = 0;
  std::size_t count_below = 0;
  while (count_below + counts[bucket] <= rank) count_below += counts[bucket++];
  // Only the rank's bucket needs sorting; of later buckets, only the smallest value matters.
  std::vector<float> bucket_values;
  bucket_values.reserve(counts[bucket]);
  float next_value = std::numeric_limits<float>::infinity();
  for (const std::vector<float>& pool : pools) {
    for (const float value : pool) {
      if (bucket_of(value) == bucket) bucket_values.push_back(value);
      if (bucket_of(value) > bucket) next_value = std::min(next_value, value);
    }
  }
  const auto rank_value = bucket_values.begin() + static_cast<std::ptrdiff_t>(rank - count_below);
  std::nth_element(bucket_values.begin(), rank_value, bucket_values.end());
  if (rank_value + 1 != bucket_values.end())
    next_value = *std::min_element(rank_value + 1, bucket_values.end());
  const double fraction = position - static_cast<double>(rank);
  return fraction > 0.0 ? *rank_value + fraction * (double{next_value} - *rank_value) : *rank_value;
}

std::vector<double> power_shares_above(SampledView field,
                                       std::span<const double> limits_cycles_per_px) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  const int columns = width / 2 + 1;
  RealFft<double> fft(height, width);
  std::vector<double> shares(limits_cycles_per_px.size(), 0.0);
  std::vector<int> first_columns(shares.size());
  double total = 0.0;
  for (float FieldSample::*component : {&FieldSample::force_x, &FieldSample::force_y}) {
    transform(field, component, fft);
    fft.spectrum()[0] = 0.0;  // only rounding errors of the mean
    for (int row = 0; row < height; ++row) {
      const double fy = static_cast<double>(std::min(row, height - row)) / height;
      std::ranges::transform(limits_cycles_per_px, first_columns.begin(),
                             [=](double limit) { return first_column_above(limit, fy, width); });
      const std::complex<double>* line =
          fft.spectrum().data() + static_cast<std::size_t>(row) * columns;
      for (int column = 0; column < columns; ++column) {
        // In all other columns, the conjugate has the same power and is not stored.
        const bool has_unstored_conjugate = column != 0 && 2 * column != width;
        const double power = (has_unstored_conjugate ? 2.0 : 1.0) * std::norm(line[column]);
        total += power;
        for (std::size_t i = 0; i < shares.size(); ++i) {
          if (column >= first_columns[i]) shares[i] += power;
        }
      }
    }
  }
  for (double& share : shares) share = total > 0.0 ? share / total : 0.0;
  return shares;
}

}  // namespace touchtrial::engine
