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

/// A 99th percentile below this share of the maximum comes from where a filter or spline fades out.
constexpr double kMinShareOfMaximum = 1e-3;
constexpr double kRoundingOfRadii = 1e-9;  // relative

constexpr double square(double value) noexcept {
  return value * value;
}

/// Root mean square over all samples, given the square of each.
template <typename SquareOf>
double root_mean(SampledView field, SquareOf square_of) noexcept {
  if (field.samples.empty()) return 0.0;
  double sum = 0.0;
  for (const FieldSample& sample : field.samples) sum += square_of(sample);
  return std::sqrt(sum / static_cast<double>(field.samples.size()));
}

/// Scale * sqrt(squares_at(pixel, width)) / (2 pitch) for every pixel that has all four neighbours.
template <typename SquaresAt>
std::vector<float> interior_norms(SampledView field, double scale, SquaresAt squares_at) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  if (height < 3 || width < 3) return {};
  const double per_mm = scale / (2.0 * field.geometry.pitch_mm);
  std::vector<float> norms(static_cast<std::size_t>(height - 2) *
                           static_cast<std::size_t>(width - 2));
  float* to = norms.data();
  for (int y = 1; y < height - 1; ++y) {
    const FieldSample* row = field.samples.data() + static_cast<std::size_t>(y) * width;
    for (int x = 1; x < width - 1; ++x) {
      *to++ = static_cast<float>(per_mm * std::sqrt(squares_at(row + x, width)));
    }
  }
  return norms;
}

/// squared_step(left, right) + squared_step(above, below) under the root.
template <typename SquaredStep>
std::vector<float> central_differences(SampledView field, double scale, SquaredStep squared_step) {
  return interior_norms(field, scale, [=](const FieldSample* at, int width) {
    return squared_step(at[-1], at[1]) + squared_step(at[-width], at[width]);
  });
}

/// With J the Jacobian of the whole F_T and P the outer product of F_T and the share's gradient,
/// the force at a share s of the ramp has the Jacobian s J + P along the plane, and F_T * per_mm in
/// depth. The norm is convex in s, so it is largest at an end of the ramp; above it, it is J's.
std::vector<float> stiffness_on_ramp(SampledView field, double scale, RampSlopes ramp) {
  const double per_step = 2.0 * field.geometry.pitch_mm * ramp.per_mm;
  return interior_norms(field, scale, [=](const FieldSample* at, int width) {
    double whole = 0.0;
    double at_top = 0.0;
    double at_touchdown = 0.0;
    for (const int step : {1, width}) {
      const FieldSample& before = at[-step];
      const FieldSample& after = at[step];
      const double share = ramp.per_grey * (double{after.height} - before.height);
      const double steps[] = {double{after.force_x} - before.force_x,
                              double{after.force_y} - before.force_y};
      const double shares[] = {share * at->force_x, share * at->force_y};
      for (const int i : {0, 1}) {
        whole += square(steps[i]);
        at_top += square(steps[i] + shares[i]);
        at_touchdown += square(shares[i]);
      }
    }
    const double in_depth = square(per_step * at->force_x) + square(per_step * at->force_y);
    return std::max(whole, std::max(at_top, at_touchdown) + in_depth);
  });
}

/// The place of a value >= 0 in the order of its leading bits: floats sort like their bits.
constexpr int kPlaceBits = 12;
std::size_t place_of(float value) noexcept {
  return std::bit_cast<std::uint32_t>(value) >> (32 - kPlaceBits);
}

/// Mean of the values that are not 0; 0 if there is none.
double mean_of_nonzero(std::span<const double> values) {
  const auto zeros = std::ranges::count(values, 0.0);
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum == 0.0 ? 0.0 : sum / static_cast<double>(std::ssize(values) - zeros);
}

/// Transforms one component of the force without its mean.
void transform(SampledView field, float FieldSample::*component, RealFft<double>& fft) {
  double sum = 0.0;
  for (const FieldSample& sample : field.samples) sum += double{sample.*component};
  const double mean = sum / static_cast<double>(field.samples.size());
  std::ranges::transform(field.samples, fft.plane().begin(), [=](const FieldSample& sample) {
    return double{sample.*component} - mean;
  });
  fft.forward();
}

/// The first column of a row of the half spectrum whose radial frequency is above a limit; the
/// number of columns if there is none. All columns behind it are above the limit as well.
int first_above(double limit_cycles_per_px, double fy, int width) {
  const double limit = limit_cycles_per_px * (1.0 + kRoundingOfRadii);
  const auto is_above = [=](int column) {
    const double fx = static_cast<double>(column) / width;
    return std::sqrt(fx * fx + fy * fy) > limit;
  };
  const int columns = width / 2 + 1;
  const double rest = std::sqrt(std::max(0.0, limit * limit - fy * fy));
  int first = static_cast<int>(std::min(rest * width, static_cast<double>(columns)));
  while (first > 0 && is_above(first - 1)) --first;
  while (first < columns && !is_above(first)) ++first;
  return first;
}

}  // namespace

double tangential_rms(SampledView field) noexcept {
  return root_mean(field,
                   [](const FieldSample& s) { return square(s.force_x) + square(s.force_y); });
}

double height_rms(SampledView field) noexcept {
  return root_mean(field, [](const FieldSample& s) { return square(s.height); });
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
  std::vector<std::size_t> counts(std::size_t{1} << kPlaceBits);
  std::size_t size = 0;
  for (const std::vector<float>& pool : pools) {
    for (const float value : pool) ++counts[place_of(value)];
    size += pool.size();
  }
  if (size == 0) return 0.0;
  const double position = share * static_cast<double>(size - 1);
  const auto rank = static_cast<std::size_t>(position);
  std::size_t place = 0;
  std::size_t below = 0;
  while (below + counts[place] <= rank) below += counts[place++];
  // Only values near the rank need sorting, and the smallest of those behind them.
  std::vector<float> near;
  near.reserve(counts[place]);
  float next = std::numeric_limits<float>::infinity();
  for (const std::vector<float>& pool : pools) {
    for (const float value : pool) {
      if (place_of(value) == place) near.push_back(value);
      if (place_of(value) > place) next = std::min(next, value);
    }
  }
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(rank - below);
  std::nth_element(near.begin(), middle, near.end());
  if (middle + 1 != near.end()) next = *std::min_element(middle + 1, near.end());
  const double rest = position - static_cast<double>(rank);
  return rest > 0.0 ? *middle + rest * (double{next} - *middle) : *middle;
}

std::vector<double> power_shares_above(SampledView field,
                                       std::span<const double> limits_cycles_per_px) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  const int columns = width / 2 + 1;
  RealFft<double> fft(height, width);
  std::vector<double> shares(limits_cycles_per_px.size(), 0.0);
  std::vector<int> first(shares.size());
  double total = 0.0;
  for (float FieldSample::*component : {&FieldSample::force_x, &FieldSample::force_y}) {
    transform(field, component, fft);
    fft.spectrum()[0] = 0.0;  // the mean's rounding
    for (int row = 0; row < height; ++row) {
      const double fy = static_cast<double>(std::min(row, height - row)) / height;
      std::ranges::transform(limits_cycles_per_px, first.begin(),
                             [=](double limit) { return first_above(limit, fy, width); });
      const std::complex<double>* line =
          fft.spectrum().data() + static_cast<std::size_t>(row) * columns;
      for (int column = 0; column < columns; ++column) {
        // Whether a coefficient's conjugate, which has the same power, is in another column and not
        // stored.
        const bool has_twin = column != 0 && 2 * column != width;
        const double power = (has_twin ? 2.0 : 1.0) * std::norm(line[column]);
        total += power;
        for (std::size_t i = 0; i < shares.size(); ++i) {
          if (column >= first[i]) shares[i] += power;
        }
      }
    }
  }
  for (double& share : shares) share = total > 0.0 ? share / total : 0.0;
  return shares;
}

}  // namespace touchtrial::engine
