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
constexpr double kMaxPx = 1 << 29;                 // so that pixel indices fit an int
constexpr double kNegligible = 1e-20;              // smaller powers of the pole are ignored

/// A row of a plane, or all its columns, filtered together.
struct Lines {
  double* first;
  int count;         ///< entries along the filter
  std::size_t step;  ///< from one entry to the next, samples
  int parallel;      ///< number of parallel lines, one sample apart

  [[nodiscard]] double* at(int i) const { return first + static_cast<std::size_t>(i) * step; }
};

/// target += factor * source, for all lines.
void add(const Lines& lines, double* target, double factor, const double* source) {
  for (int j = 0; j < lines.parallel; ++j) target[j] += factor * source[j];
}

void scale(const Lines& lines, double* entries, double factor) {
  for (int j = 0; j < lines.parallel; ++j) entries[j] *= factor;
}

/// Computes the causal filter's state before the first sample of the endlessly mirrored sequence:
/// the sum over one period, s_0 .. s_(n-1) s_(n-1) .. s_0, weighted by pole^i, divided by 1 -
/// pole^(2n).
void start_causal(const Lines& lines, std::vector<double>& state) {
  state.assign(static_cast<std::size_t>(lines.parallel), 0.0);
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

}  // namespace

Plane<double> cubic_spline_coefficients(Plane<double> samples) {
  const int height = samples.height();
  const int width = samples.width();
  const auto stride = static_cast<std::size_t>(width);
  double* first = samples.samples().data();
  // Subtracting a level loses no digits and keeps a constant plane exactly constant.
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

PatchSums spline_at(std::span<const float> coefficients, int height_px, int width_px, double x_px,
                    double y_px) {
  const SumOfPatch sum = spline_sum();
  const Patches patches(coefficients, height_px, width_px, sum);
  if (patches.has({x_px, y_px})) return patches.at({x_px, y_px});
  const double x = std::clamp(x_px, -kMaxPx, kMaxPx);
  const double y = std::clamp(y_px, -kMaxPx, kMaxPx);
  const double left = std::floor(x);
  const double top = std::floor(y);
  const int column = static_cast<int>(left) - 1;
  const int row = static_cast<int>(top) - 1;
  std::array<float, 16> mirrored_patch;
  for (int dy = 0; dy < 4; ++dy) {
    const auto row_index = static_cast<std::size_t>(symmetric_index(row + dy, height_px));
    for (int dx = 0; dx < 4; ++dx) {
      const auto column_index = static_cast<std::size_t>(symmetric_index(column + dx, width_px));
      mirrored_patch[4 * dy + dx] =
          coefficients[row_index * static_cast<std::size_t>(width_px) + column_index];
    }
  }
  return sum(mirrored_patch.data(), 4, x - left, y - top);
}

}  // namespace touchtrial::engine
