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

/// Returns 1 on the plane and 0 beyond the rim, twice continuously differentiable in between.
Fade fade_at(double coordinate_mm, double side_mm) noexcept {
  const double beyond_mm = std::max(-coordinate_mm, coordinate_mm - side_mm);
  if (beyond_mm <= 0.0) return {};
  if (beyond_mm >= kRimMm) return {0.0, 0.0};
  const double s = beyond_mm / kRimMm;
  const double sign = coordinate_mm < 0.0 ? -1.0 : 1.0;
  const double t = 1.0 - s;
  return {1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0)), -sign * 30.0 * s * s * t * t / kRimMm};
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStiffnessTolerance = 2e-7;      // relative; pools have single precision
constexpr double kSurfaceBudgetTolerance = 1e-6;  // relative
constexpr int kMaxIterations = 60;

/// Weighted sums of three coefficients of a column, for the value and slope at its middle.
struct Column {
  float value;
  float slope;
};

/// The columns of three rows; beyond an edge the outer row is repeated.
std::vector<Column> columns_around(FieldView field, int y) {
  const int width = field.geometry.width_px;
  const auto row = [&](int index) {
    const int clamped_y = std::clamp(index, 0, field.geometry.height_px - 1);
    return field.heights.data() + static_cast<std::size_t>(clamped_y) * width;
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

/// Samples the spline of a field at its pixel centres; the force is minus the gradient of h. Cost:
/// about 5 ns per pixel.
SampledField sample_relief(FieldView field) {
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

/// The lateral force at a neighbour of a pixel, at the height where the pixel has a load of
/// kReferenceLoadN.
Vec2 force_at_neighbour(const FieldSample& middle, const FieldSample& neighbour, double lateral,
                        double normal) noexcept {
  const double load_n =
      std::max(0.0, kReferenceLoadN + normal * (double{neighbour.height} - middle.height));
  return {lateral * load_n * neighbour.force_x, lateral * load_n * neighbour.force_y};
}

/// The Frobenius norm of the in-plane Jacobian at every interior pixel of a relief, in N/mm, by
/// central differences of the lateral force at the height where the central pixel has a load of
/// kReferenceLoadN.
/// \param mm_per_grey  alpha
/// \param wall_n_per_mm  k; 0: only the part linear in alpha
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
      const auto neighbour_force = [&](int step) {
        return force_at_neighbour(row[x], row[x + step], lateral, normal);
      };
      const Vec2 difference_x = neighbour_force(1) - neighbour_force(-1);
      const Vec2 difference_y = neighbour_force(width) - neighbour_force(-width);
      const double step_n =
          std::sqrt(difference_x.x * difference_x.x + difference_x.y * difference_x.y +
                    difference_y.x * difference_y.x + difference_y.y * difference_y.y);
      pool.push_back(static_cast<float>(step_n / (2.0 * relief.geometry.pitch_mm)));
    }
  }
  return pool;
}

/// Newtons per (grey level per pixel) of the relief's force, at a load of kReferenceLoadN.
double surface_n_per_grey(FieldView field, Gains gains) noexcept {
  return kReferenceLoadN * gains.height_mm / field.geometry.pitch_mm;
}

/// The fields of a study with their equalising factors. Recomputes the reliefs for every stiffness,
/// which makes choosing alpha about six times slower but saves the memory of all reliefs.
class Surfaces {
 public:
  Surfaces(std::span<const FieldView> fields, const RenderingOptions& options)
      : fields_(fields), wall_n_per_mm_(options.stiffness_n_per_mm) {
    rms_.resize(fields.size());
    in_parallel(jobs_for(fields), fields.size(),
                [&](std::size_t i) { rms_[i] = tangential_rms(sample_relief(fields[i]).view()); });
    factors_ = equalising_factors(rms_, options.equalise);
  }

  [[nodiscard]] const std::vector<double>& rms() const noexcept { return rms_; }
  [[nodiscard]] const std::vector<double>& factors() const noexcept { return factors_; }

  /// Stiffness of the normal force, N/mm, per mm per grey level of alpha.
  [[nodiscard]] double normal_stiffness() const {
    return pool_stiffness([&](SampledView relief, double factor) {
      return height_stiffness(relief, factor * wall_n_per_mm_);
    });
  }
  /// Stiffness of the lateral force at a load of kReferenceLoadN, N/mm, for an alpha in mm per grey
  /// level.
  [[nodiscard]] double lateral_stiffness(double mm_per_grey) const {
    return pool_stiffness([&](SampledView relief, double factor) {
      return stiffness_at_load(relief, mm_per_grey * factor, wall_n_per_mm_);
    });
  }
  /// Derivative of lateral_stiffness() at alpha = 0.
  [[nodiscard]] double linear_stiffness() const {
    return pool_stiffness(
        [](SampledView relief, double factor) { return stiffness_at_load(relief, factor, 0.0); });
  }

 private:
  template <typename StiffnessOf>
  [[nodiscard]] double pool_stiffness(StiffnessOf stiffness_of) const {
    std::vector<std::vector<float>> pools(fields_.size());
    in_parallel(jobs_for(fields_), fields_.size(), [&](std::size_t i) {
      if (rms_[i] > 0.0) pools[i] = stiffness_of(sample_relief(fields_[i]).view(), factors_[i]);
    });
    return typical_stiffness(pools);
  }

  std::span<const FieldView> fields_;
  double wall_n_per_mm_;
  std::vector<double> rms_;
  std::vector<double> factors_;
};

/// The alpha, at most `limit`, at which the lateral stiffness equals the budget. Stiffness is
/// nearly a power of alpha, with exponents from 1 (small heights) to 2 (large), so a bracketed
/// secant method on the logarithms converges in a few iterations.
double lateral_limit(const Surfaces& surfaces, double budget, double limit) {
  const double linear = surfaces.linear_stiffness();
  if (linear == 0.0) return limit;
  if (limit < kInfinity && surfaces.lateral_stiffness(limit) <= budget) return limit;
  double low = 0.0;
  double high = limit;
  double alpha = budget / linear;
  double previous = 0.0;
  double previous_error = 0.0;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (!(alpha > low && alpha < high)) alpha = 0.5 * (low + high);
    const double log_error = std::log(budget / surfaces.lateral_stiffness(alpha));
    if (std::abs(log_error) <= kStiffnessTolerance) return alpha;
    (log_error > 0.0 ? low : high) = alpha;
    const double power = (previous_error - log_error) / std::log(alpha / previous);
    const double step = log_error / (previous > 0.0 ? std::clamp(power, 0.5, 4.0) : 1.0);
    previous = alpha;
    previous_error = log_error;
    alpha *= std::exp(step);
  }
  return low;
}

double alpha_within_budget(const Surfaces& surfaces, double budget) {
  const double normal = surfaces.normal_stiffness();
  const double limit = lateral_limit(surfaces, budget, normal > 0.0 ? budget / normal : kInfinity);
  return limit < kInfinity ? limit : 0.0;
}

StudyGains choose_surface_gains(std::span<const FieldView> fields,
                                const RenderingOptions& options) {
  const Surfaces surfaces(fields, options);
  const double budget = options.texture_stiffness_n_per_mm;
  StudyGains gains;
  double alpha = 0.0;
  if (options.gains) {
    alpha = explicit_factor(options.gains->height_mm, surfaces.rms(), options.equalise);
    const double max_stiffness =
        std::max(surfaces.lateral_stiffness(alpha), alpha * surfaces.normal_stiffness());
    gains.over_budget = max_stiffness > budget * (1.0 + kSurfaceBudgetTolerance);
  } else {
    alpha = alpha_within_budget(surfaces, budget);
  }
  for (const double factor : surfaces.factors()) {
    gains.per_field.push_back({.height_mm = alpha * factor});
  }
  return gains;
}

TextureField make_surface_field(Plane<double> smooth, const RenderingOptions& options) {
  const PlaneGeometry geometry{options.pitch_mm, smooth.height(), smooth.width()};
  const Plane<double> coefficients = cubic_spline_coefficients(std::move(smooth));
  return TextureField({.geometry = geometry, .model = ModelKind::surface},
                      converted<float>(coefficients));
}

FieldStatistics surface_statistics(FieldView field, Gains gains, const RenderingOptions& options) {
  const SampledField relief = sample_relief(field);
  const SampledView view = relief.view();
  require_finite_rms(tangential_rms(view), height_rms(view));
  FieldStatistics statistics = lateral_statistics(view, surface_n_per_grey(field, gains));
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
      // A B-spline is a weighted mean of its coefficients, so it never exceeds the highest.
      reach_mm_(mm_per_grey_ > 0.0 ? std::max(0.0, mm_per_grey_ * field.highest) : 0.0) {}

Vec3 SurfaceModel::force_n(const Vec3& position, const Vec3& velocity_mm_s,
                           Bristle& bristle) const noexcept {
  const Vec3 position_mm = copy_by_component(position);
  const bool is_in_reach = position_mm.z < reach_mm_;
  Relief relief;
  double elastic_n = 0.0;
  if (is_in_reach && is_finite(position_mm) && is_finite(velocity_mm_s)) {
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
  return limit_norm(force_n, max_force_n_);
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
  const Fade fade_x = on_plane ? Fade{} : fade_at(x_mm, plane.width_mm());
  const Fade fade_y = on_plane ? Fade{} : fade_at(y_mm, plane.height_mm());
  if (fade_x.value == 0.0 || fade_y.value == 0.0) return {};
  const Vec2 px = plane.to_px(x_mm, y_mm);
  const PatchSums h = spline_at(field_.heights, plane.height_px, plane.width_px, px.x, px.y);
  const double height_mm = mm_per_grey_ * h.value;
  return {height_mm * fade_x.value * fade_y.value,
          {(slope_per_grey_ * h.along_x * fade_x.value + height_mm * fade_x.slope) * fade_y.value,
           (slope_per_grey_ * h.along_y * fade_y.value + height_mm * fade_y.slope) * fade_x.value}};
}

ModelParts surface_parts() noexcept {
  return {make_surface_field, sample_relief, choose_surface_gains, surface_statistics,
          surface_n_per_grey};
}

}  // namespace touchtrial::engine
