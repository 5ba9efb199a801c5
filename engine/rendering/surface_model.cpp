#include "engine/rendering/surface_model.hpp"

#include "core/parallel.hpp"
#include "engine/rendering/cubic_spline.hpp"
#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/model_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace touchtrial::engine {
namespace {

/// A factor along one axis, and its change per mm.
struct Fade {
  double value = 1.0;
  double slope = 0.0;
};

/// 1 on the plane, 0 beyond the rim, twice continuously differentiable in between.
Fade fade_at(double place_mm, double side_mm) noexcept {
  const double beyond_mm = std::max(-place_mm, place_mm - side_mm);
  if (beyond_mm <= 0.0) return {};
  if (beyond_mm >= kRimMm) return {0.0, 0.0};
  const double s = beyond_mm / kRimMm;
  const double outwards = place_mm < 0.0 ? -1.0 : 1.0;
  const double rest = 1.0 - s;
  return {1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0)),
          -outwards * 30.0 * s * s * rest * rest / kRimMm};
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNearEnough = 2e-7;       // relative; pools have single precision
constexpr double kSlackOfSurfaces = 1e-6;  // relative; less above the budget is rounding
constexpr int kMaxTries = 60;

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
    return field.heights.data() + static_cast<std::size_t>(inside) * width;
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

/// The spline of a field at its pixel centres; the force is minus the gradient of h. Cost: some 5
/// ns a pixel.
SampledField relief_of(FieldView field) {
  const PlaneGeometry& plane = field.geometry;
  SampledField relief{plane, {plane.height_px, plane.width_px}};
  for (int y = 0; y < plane.height_px; ++y) {
    const std::vector<Column> columns = columns_around(field, y);
    for (int x = 0; x < plane.width_px; ++x) {
      const Column& left = columns[std::max(x - 1, 0)];
      const Column& middle = columns[x];
      const Column& right = columns[std::min(x + 1, plane.width_px - 1)];
      relief.samples.at(y, x) = {
          static_cast<float>((left.value + 4.0 * middle.value + right.value) / 6.0),
          static_cast<float>(-0.5 * (double{right.value} - left.value)),
          static_cast<float>(-(left.slope + 4.0 * middle.slope + right.slope) / 6.0)};
    }
  }
  return relief;
}

/// The lateral force at a neighbour of a pixel, at the height at which the pixel meets the stated
/// load.
Vec2 force_beside(const FieldSample& middle, const FieldSample& beside, double lateral,
                  double normal) noexcept {
  const double load_n =
      std::max(0.0, kStatedLoadN + normal * (double{beside.height} - middle.height));
  return {lateral * load_n * beside.force_x, lateral * load_n * beside.force_y};
}

/// The Frobenius norm of the in-plane Jacobian at every interior pixel of a relief, in N/mm:
/// central differences, over the pitch, of the model's lateral force at the height above the plane
/// at which the pixel in the middle meets a load of kStatedLoadN.
/// \param mm_per_grey  alpha
/// \param wall_n_per_mm  k; 0 leaves only the part that is linear in alpha
std::vector<float> stiffness_at_load(SampledView relief, double mm_per_grey, double wall_n_per_mm) {
  const int height = relief.geometry.height_px;
  const int width = relief.geometry.width_px;
  if (height < 3 || width < 3) return {};
  std::vector<float> pool;
  pool.reserve(relief.samples.size());
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
  return pool;
}

/// Newtons of one grey level per pixel of the relief's force, at the stated load.
double newtons_per_grey(FieldView field, Gains gains) noexcept {
  return kStatedLoadN * gains.height_mm / field.geometry.pitch_mm;
}

/// The fields of a study, each with the factor that equalises it. Every stiffness recomputes the
/// reliefs: choosing alpha takes about six times their time, but saves the memory of all of them.
class Surfaces {
 public:
  Surfaces(std::span<const FieldView> fields, const RenderingOptions& options)
      : fields_(fields), wall_n_per_mm_(options.stiffness_n_per_mm) {
    rms_.resize(fields.size());
    in_parallel(jobs_for(fields), fields.size(),
                [&](std::size_t i) { rms_[i] = tangential_rms(relief_of(fields[i]).view()); });
    factor_ = equalising_factors(rms_, options.equalise);
  }

  [[nodiscard]] const std::vector<double>& rms() const noexcept { return rms_; }
  [[nodiscard]] const std::vector<double>& factors() const noexcept { return factor_; }

  /// Stiffness of the normal force, N/mm, per mm per grey level of alpha.
  [[nodiscard]] double normal_stiffness() const {
    return pooled([&](SampledView relief, double factor) {
      return height_stiffness(relief, factor * wall_n_per_mm_);
    });
  }
  /// Stiffness of the lateral force at the stated load, N/mm, at this alpha.
  [[nodiscard]] double lateral_stiffness(double mm_per_grey) const {
    return pooled([&](SampledView relief, double factor) {
      return stiffness_at_load(relief, mm_per_grey * factor, wall_n_per_mm_);
    });
  }
  /// The same per mm per grey level of alpha, in the limit of small heights.
  [[nodiscard]] double linear_stiffness() const {
    return pooled(
        [](SampledView relief, double factor) { return stiffness_at_load(relief, factor, 0.0); });
  }

 private:
  template <typename StiffnessOf>
  [[nodiscard]] double pooled(StiffnessOf stiffness_of) const {
    std::vector<std::vector<float>> pools(fields_.size());
    in_parallel(jobs_for(fields_), fields_.size(), [&](std::size_t i) {
      if (rms_[i] > 0.0) pools[i] = stiffness_of(relief_of(fields_[i]).view(), factor_[i]);
    });
    return typical_stiffness(pools);
  }

  std::span<const FieldView> fields_;
  double wall_n_per_mm_;
  std::vector<double> rms_;
  std::vector<double> factor_;
};

/// The alpha, at most `limit`, at which the lateral force is as stiff as the budget. Stiffness is
/// nearly a power of alpha, with an exponent of 1 for small heights and up to 2 for large ones: a
/// secant method on the logarithms, within a bracket, finds alpha in a few iterations.
double lateral_limit(const Surfaces& surfaces, double budget, double limit) {
  const double linear = surfaces.linear_stiffness();
  if (linear == 0.0) return limit;
  if (limit < kInfinity && surfaces.lateral_stiffness(limit) <= budget) return limit;
  double low = 0.0;
  double high = limit;
  double alpha = budget / linear;
  double earlier = 0.0;
  double earlier_short_of = 0.0;
  for (int i = 0; i < kMaxTries; ++i) {
    if (!(alpha > low && alpha < high)) alpha = 0.5 * (low + high);
    const double short_of = std::log(budget / surfaces.lateral_stiffness(alpha));
    if (std::abs(short_of) <= kNearEnough) return alpha;
    (short_of > 0.0 ? low : high) = alpha;
    const double power = (earlier_short_of - short_of) / std::log(alpha / earlier);
    const double step = short_of / (earlier > 0.0 ? std::clamp(power, 0.5, 4.0) : 1.0);
    earlier = alpha;
    earlier_short_of = short_of;
    alpha *= std::exp(step);
  }
  return low;
}

double within_budget(const Surfaces& surfaces, double budget) {
  const double normal = surfaces.normal_stiffness();
  const double limit = lateral_limit(surfaces, budget, normal > 0.0 ? budget / normal : kInfinity);
  return limit < kInfinity ? limit : 0.0;
}

StudyGains gains_of_surfaces(std::span<const FieldView> fields, const RenderingOptions& options) {
  const Surfaces surfaces(fields, options);
  const double budget = options.texture_stiffness_n_per_mm;
  StudyGains gains;
  double alpha = 0.0;
  if (options.gains) {
    alpha = explicit_factor(options.gains->height_mm, surfaces.rms(), options.equalise);
    const double stiffest =
        std::max(surfaces.lateral_stiffness(alpha), alpha * surfaces.normal_stiffness());
    gains.over_budget = stiffest > budget * (1.0 + kSlackOfSurfaces);
  } else {
    alpha = within_budget(surfaces, budget);
  }
  for (const double factor : surfaces.factors()) {
    gains.of_field.push_back({.height_mm = alpha * factor});
  }
  return gains;
}

TextureField field_of_surface(Plane<double> smooth, const RenderingOptions& options) {
  const PlaneGeometry geometry{options.pitch_mm, smooth.height(), smooth.width()};
  const Plane<double> exact = cubic_spline_coefficients(std::move(smooth));
  return TextureField({.geometry = geometry, .model = ModelKind::surface}, converted<float>(exact));
}

FieldStatistics statistics_of_surface(FieldView field, Gains gains,
                                      const RenderingOptions& options) {
  const SampledField relief = relief_of(field);
  const SampledView view = relief.view();
  require_finite_rms(tangential_rms(view), height_rms(view));
  FieldStatistics statistics = lateral_statistics(view, newtons_per_grey(field, gains));
  statistics.normal_rms_n = options.stiffness_n_per_mm * gains.height_mm * height_rms(view);
  const std::vector<float> stiffness =
      stiffness_at_load(view, gains.height_mm, options.stiffness_n_per_mm);
  statistics.stiffness_p99_n_per_mm = percentile({&stiffness, 1}, 0.99);
  return statistics;
}

}  // namespace

SurfaceModel::SurfaceModel(FieldView field, const RenderingOptions& options, Gains gains)
    : field_(field),
      stiffness_n_per_mm_(options.stiffness_n_per_mm),
      damping_n_s_per_mm_(options.damping_n_s_per_mm),
      friction_(options.friction),
      bristle_n_per_mm_(options.texture_stiffness_n_per_mm / std::numbers::sqrt2),
      max_force_n_(options.max_force_n),
      mm_per_grey_(field.empty() || field.model != ModelKind::surface ? 0.0 : gains.height_mm),
      slope_per_grey_(mm_per_grey_ / field.geometry.pitch_mm),
      patches_(mm_per_grey_ == 0.0 ? Patches{}
                                   : Patches(field.heights, field.geometry.height_px,
                                             field.geometry.width_px, spline_sum())),
      // A B-spline is a weighted mean of its coefficients, and so never above the highest.
      reach_mm_(mm_per_grey_ > 0.0 ? std::max(0.0, mm_per_grey_ * field.highest) : 0.0) {}

Vec3 SurfaceModel::force_n(const Vec3& position, const Vec3& velocity_mm_s,
                           Bristle& bristle) const noexcept {
  const Vec3 position_mm = by_number(position);
  const bool in_reach = position_mm.z < reach_mm_;
  Relief relief;
  double elastic_n = 0.0;
  if (in_reach && is_finite(position_mm) && is_finite(velocity_mm_s)) {
    relief = relief_at(position_mm.x, position_mm.y);
    elastic_n = stiffness_n_per_mm_ * (relief.height_mm - position_mm.z);
  }
  if (!(elastic_n > 0.0)) {
    bristle.release();
    return {};
  }
  const double normal_n = std::max(0.0, elastic_n - damping_n_s_per_mm_ * velocity_mm_s.z);
  Vec3 force_n{-elastic_n * relief.slope.x, -elastic_n * relief.slope.y, normal_n};
  if (friction_ > 0.0) {
    const Vec2 friction_n =
        bristle.friction_n({position_mm.x, position_mm.y}, friction_ * normal_n, bristle_n_per_mm_);
    force_n.x += friction_n.x;
    force_n.y += friction_n.y;
  }
  return limited_in_norm(force_n, max_force_n_);
}

inline SurfaceModel::Relief SurfaceModel::relief_at(double x_mm, double y_mm) const noexcept {
  const PlaneGeometry& plane = field_.geometry;
  const Vec2 px = plane.to_px(x_mm, y_mm);
  if (patches_.has(px)) {
    const PatchSums h = patches_.at(px);
    return {mm_per_grey_ * h.value, {slope_per_grey_ * h.along_x, slope_per_grey_ * h.along_y}};
  }
  return relief_at_edge(x_mm, y_mm);
}

SurfaceModel::Relief SurfaceModel::relief_at_edge(double x_mm, double y_mm) const noexcept {
  if (mm_per_grey_ == 0.0) return {};
  const PlaneGeometry& plane = field_.geometry;
  const bool on_plane = plane.contains(x_mm, y_mm);
  const Fade across = on_plane ? Fade{} : fade_at(x_mm, plane.width_mm());
  const Fade down = on_plane ? Fade{} : fade_at(y_mm, plane.height_mm());
  if (across.value == 0.0 || down.value == 0.0) return {};
  const Vec2 px = plane.to_px(x_mm, y_mm);
  const PatchSums h = spline_at(field_.heights, plane.height_px, plane.width_px, px.x, px.y);
  const double height_mm = mm_per_grey_ * h.value;
  return {height_mm * across.value * down.value,
          {(slope_per_grey_ * h.along_x * across.value + height_mm * across.slope) * down.value,
           (slope_per_grey_ * h.along_y * down.value + height_mm * down.slope) * across.value}};
}

// What make_texture_field, choose_gains, field_statistics and lateral_field do for this model.

ModelParts surface_parts() noexcept {
  return {field_of_surface, relief_of, gains_of_surfaces, statistics_of_surface, newtons_per_grey};
}

}  // namespace touchtrial::engine
