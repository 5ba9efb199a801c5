#include "engine/rendering/field_measures.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::engine {
namespace {

/// A 99th percentile below this share of the maximum says where a filter or a spline fades out.
constexpr double kLeastShareOfMaximum = 1e-3;

constexpr double square(double value) noexcept {
  return value * value;
}

/// Root mean square over all samples, given the square of each.
template <typename SquareOf>
double root_mean(FieldView field, SquareOf square_of) noexcept {
  if (field.samples.empty()) return 0.0;
  double sum = 0.0;
  for (const FieldSample& sample : field.samples) sum += square_of(sample);
  return std::sqrt(sum / static_cast<double>(field.samples.size()));
}

/// Appends scale * sqrt(squared_step(left, right) + squared_step(above, below)) / (2 pitch) for
/// every pixel that has all four neighbours.
template <typename SquaredStep>
void append_central_differences(FieldView field, double scale, std::vector<float>& pool,
                                SquaredStep squared_step) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  if (height < 3 || width < 3) return;
  const double per_mm = scale / (2.0 * field.geometry.pitch_mm);
  for (int y = 1; y < height - 1; ++y) {
    const FieldSample* row = field.samples.data() + static_cast<std::size_t>(y) * width;
    for (int x = 1; x < width - 1; ++x) {
      const double squares =
          squared_step(row[x - 1], row[x + 1]) + squared_step(row[x - width], row[x + width]);
      pool.push_back(static_cast<float>(per_mm * std::sqrt(squares)));
    }
  }
}

}  // namespace

double tangential_rms(FieldView field) noexcept {
  return root_mean(field,
                   [](const FieldSample& s) { return square(s.force_x) + square(s.force_y); });
}

double normal_rms(FieldView field) noexcept {
  return root_mean(field, [](const FieldSample& s) { return square(double{s.surface} - 128.0); });
}

void append_tangential_stiffness(FieldView field, double scale, std::vector<float>& pool) {
  append_central_differences(field, scale, pool, [](const FieldSample& a, const FieldSample& b) {
    return square(double{b.force_x} - a.force_x) + square(double{b.force_y} - a.force_y);
  });
}

void append_normal_stiffness(FieldView field, double scale, std::vector<float>& pool) {
  append_central_differences(field, scale, pool, [](const FieldSample& a, const FieldSample& b) {
    return square(double{b.surface} - a.surface);
  });
}

double mean_of_nonzero(std::span<const double> values) {
  const auto zeros = std::ranges::count(values, 0.0);
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum == 0.0 ? 0.0 : sum / static_cast<double>(std::ssize(values) - zeros);
}

double typical_stiffness(std::vector<float>& pool) {
  const double typical = percentile(pool, 0.99);
  const double largest = percentile(pool, 1.0);
  return typical > kLeastShareOfMaximum * largest ? typical : largest;
}

double percentile(std::vector<float>& pool, double share) {
  if (pool.empty()) return 0.0;
  const double position = share * static_cast<double>(pool.size() - 1);
  const double whole = std::floor(position);
  const auto middle = pool.begin() + static_cast<std::ptrdiff_t>(whole);
  std::nth_element(pool.begin(), middle, pool.end());
  const auto next = std::min_element(middle + 1, pool.end());
  if (next == pool.end()) return *middle;
  return *middle + (position - whole) * (double{*next} - *middle);
}

}  // namespace touchtrial::engine
