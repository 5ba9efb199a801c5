#include "engine/rendering/cubic_spline.hpp"

#include "engine/rendering/model_parts.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace touchtrial::engine {
namespace {

constexpr double kPole = -0.26794919243112270647;  // sqrt 3 - 2
constexpr double kGain = 6.0;                      // (1 - pole) (1 - 1 / pole)
constexpr double kFarthestPx = 1 << 29;            // whole pixels still fit an int
constexpr double kNegligible = 1e-20;              // of a power of the pole, relative to 1

/// A row of a plane, or all its columns, which are filtered together.
struct Lines {
  double* first;
  int count;         ///< entries along the filter
  std::size_t step;  ///< from one entry to the next, samples
  int side_by_side;  ///< parallel lines, one sample apart

  [[nodiscard]] double* at(int i) const { return first + static_cast<std::size_t>(i) * step; }
};

/// to += factor * from, for all lines.
void add(const Lines& lines, double* to, double factor, const double* from) {
  for (int j = 0; j < lines.side_by_side; ++j) to[j] += factor * from[j];
}

void scale(const Lines& lines, double* entries, double factor) {
  for (int j = 0; j < lines.side_by_side; ++j) entries[j] *= factor;
}

/// The causal filter's state before the first sample of the endlessly mirrored sequence: the sum
/// over one period, s_0 .. s_(n-1) s_(n-1) .. s_0, weighted by pole^i, divided by 1 - pole^(2n).
void start_causal(const Lines& lines, std::vector<double>& state) {
  state.assign(static_cast<std::size_t>(lines.side_by_side), 0.0);
  const double end = std::pow(kPole, lines.count);
  double power = kPole;
  for (int i = 0; i < lines.count && std::abs(power) > kNegligible; ++i) {
    add(lines, state.data(), power, lines.at(i));
    add(lines, state.data(), power * end, lines.at(lines.count - 1 - i));
    power *= kPole;
  }
  scale(lines, state.data(), 1.0 / (1.0 - end * end));
}

void filter(const Lines& lines, std::vector<double>& state) {
  for (int i = 0; i < lines.count; ++i) scale(lines, lines.at(i), kGain);
  start_causal(lines, state);
  add(lines, lines.at(0), 1.0, state.data());
  for (int i = 1; i < lines.count; ++i) add(lines, lines.at(i), kPole, lines.at(i - 1));
  scale(lines, lines.at(lines.count - 1), kPole / (kPole - 1.0));
  for (int i = lines.count - 2; i >= 0; --i) {
    add(lines, lines.at(i), -1.0, lines.at(i + 1));
    scale(lines, lines.at(i), -kPole);
  }
}

/// Two numbers side by side in a register: without this type compilers do not vectorise the sums.
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

/// Weights of the four coefficients around a point, along x and along y.
struct Weights {
  std::array<Pair, 4> value;
  std::array<Pair, 4> slope;
};

/// Weights for a point at a distance t, 0 <= t < 1, beyond the second coefficient of each axis.
Weights weights_at(Pair t) noexcept {
  constexpr double kSixth = 1.0 / 6.0;
  const Pair u = 1.0 - t;
  return {{kSixth * u * u * u, kSixth * (4.0 + t * t * (3.0 * t - 6.0)),
           kSixth * (4.0 + u * u * (3.0 * u - 6.0)), kSixth * t * t * t},
          {-0.5 * u * u, t * (1.5 * t - 2.0), -u * (1.5 * u - 2.0), 0.5 * t * t}};
}

/// The sum over four columns with the weights of the x axis.
double across(const std::array<Pair, 4>& weights, Pair first, Pair second) noexcept {
  const Pair sum =
      first * Pair{weights[0][0], weights[1][0]} + second * Pair{weights[2][0], weights[3][0]};
  return sum[0] + sum[1];
}

/// Sums the 4 x 4 coefficients, whose rows `row_at(row)` points to: along the columns first.
template <typename RowAt>
SplinePoint summed(const Weights& at, RowAt row_at) noexcept {
  Pair value_first{};
  Pair value_second{};
  Pair slope_first{};
  Pair slope_second{};
  for (int row = 0; row < 4; ++row) {
    const float* c = row_at(row);
    const Pair first = {c[0], c[1]};
    const Pair second = {c[2], c[3]};
    value_first += at.value[row][1] * first;
    value_second += at.value[row][1] * second;
    slope_first += at.slope[row][1] * first;
    slope_second += at.slope[row][1] * second;
  }
  return {across(at.value, value_first, value_second), across(at.slope, value_first, value_second),
          across(at.value, slope_first, slope_second)};
}

}  // namespace

Plane<double> cubic_spline_coefficients(Plane<double> samples) {
  const int height = samples.height();
  const int width = samples.width();
  const auto stride = static_cast<std::size_t>(width);
  double* first = samples.samples().data();
  // Without its level, which costs no digits, a constant plane stays exactly constant.
  const double level = *first;
  for (double& sample : samples.samples()) sample -= level;
  std::vector<double> state;
  for (int y = 0; y < height; ++y) {
    filter({first + static_cast<std::size_t>(y) * stride, width, 1, 1}, state);
  }
  filter({first, height, stride, width}, state);
  for (double& coefficient : samples.samples()) coefficient += level;
  return samples;
}

SplinePoint spline_at(std::span<const float> coefficients, int height_px, int width_px, double x_px,
                      double y_px) noexcept {
  const double x_in_range = std::clamp(x_px, -kFarthestPx, kFarthestPx);
  const double y_in_range = std::clamp(y_px, -kFarthestPx, kFarthestPx);
  const double left = std::floor(x_in_range);
  const double top = std::floor(y_in_range);
  const Weights at = weights_at(Pair{x_in_range - left, y_in_range - top});
  const int column = static_cast<int>(left) - 1;
  const int row = static_cast<int>(top) - 1;
  const auto stride = static_cast<std::size_t>(width_px);
  if (column >= 0 && row >= 0 && column + 4 <= width_px && row + 4 <= height_px) {
    const float* corner = coefficients.data() + static_cast<std::size_t>(row) * stride + column;
    fetch_rows_beside(corner, stride);
    return summed(at, [=](int dy) { return corner + static_cast<std::size_t>(dy) * stride; });
  }
  std::array<float, 4> mirrored;
  return summed(at, [&](int dy) {
    const auto at_row = static_cast<std::size_t>(symmetric_index(row + dy, height_px));
    for (int dx = 0; dx < 4; ++dx) {
      mirrored[dx] = coefficients[at_row * stride + symmetric_index(column + dx, width_px)];
    }
    return mirrored.data();
  });
}

}  // namespace touchtrial::engine
