#include "engine/rendering/surface_measures.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::engine {
namespace {

/// A column of three coefficients, weighted for the value and for the slope at its middle.
struct Column {
  float value;
  float slope;
};

/// The columns of three rows; at an edge the row itself is its mirror image.
std::vector<Column> columns_around(FieldView field, int y) {
  const int width = field.geometry.width_px;
  const auto row = [&](int at) {
    const int inside = std::clamp(at, 0, field.geometry.height_px - 1);
    return field.coefficients.data() + static_cast<std::size_t>(inside) * width;
  };
  const float* above = row(y - 1);
  const float* middle = row(y);
  const float* below = row(y + 1);
  std::vector<Column> columns(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) {
    const double a = above[x];
    const double b = below[x];
    columns[x] = {static_cast<float>((a + 4.0 * middle[x] + b) / 6.0),
                  static_cast<float>(0.5 * (b - a))};
  }
  return columns;
}

/// The force on a stylus beside the pixel where it meets the stated load.
Vec2 force_beside(const FieldSample& middle, const FieldSample& beside, double lateral,
                  double normal) noexcept {
  const double load_n =
      std::max(0.0, kStatedLoadN + normal * (double{beside.surface} - middle.surface));
  return {lateral * load_n * beside.force_x, lateral * load_n * beside.force_y};
}

}  // namespace

TextureField relief_of(FieldView field) {
  const PlaneGeometry& plane = field.geometry;
  Plane<FieldSample> relief(plane.height_px, plane.width_px);
  for (int y = 0; y < plane.height_px; ++y) {
    const std::vector<Column> columns = columns_around(field, y);
    for (int x = 0; x < plane.width_px; ++x) {
      const Column& left = columns[std::max(x - 1, 0)];
      const Column& middle = columns[x];
      const Column& right = columns[std::min(x + 1, plane.width_px - 1)];
      relief.at(y, x) = {
          static_cast<float>((left.value + 4.0 * middle.value + right.value) / 6.0),
          static_cast<float>(-0.5 * (double{right.value} - left.value)),
          static_cast<float>(-(left.slope + 4.0 * middle.slope + right.slope) / 6.0)};
    }
  }
  return {plane, std::move(relief)};
}

double height_rms(FieldView relief) noexcept {
  double sum = 0.0;
  for (const FieldSample& sample : relief.samples) sum += double{sample.surface} * sample.surface;
  return std::sqrt(sum / static_cast<double>(relief.samples.size()));
}

void append_stiffness_at_load(FieldView relief, double mm_per_grey, double wall_n_per_mm,
                              std::vector<float>& pool) {
  const int height = relief.geometry.height_px;
  const int width = relief.geometry.width_px;
  if (height < 3 || width < 3) return;
  const double lateral = mm_per_grey / relief.geometry.pitch_mm;
  const double normal = mm_per_grey * wall_n_per_mm;
  for (int y = 1; y < height - 1; ++y) {
    const FieldSample* row = relief.samples.data() + static_cast<std::size_t>(y) * width;
    for (int x = 1; x < width - 1; ++x) {
      const auto beside = [&](int step) {
        return force_beside(row[x], row[x + step], lateral, normal);
      };
      const Vec2 along = beside(1) - beside(-1);
      const Vec2 down = beside(width) - beside(-width);
      const double step_n =
          std::sqrt(along.x * along.x + along.y * along.y + down.x * down.x + down.y * down.y);
      pool.push_back(static_cast<float>(step_n / (2.0 * relief.geometry.pitch_mm)));
    }
  }
}

}  // namespace touchtrial::engine
