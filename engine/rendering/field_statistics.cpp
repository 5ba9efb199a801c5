#include "engine/rendering/field_statistics.hpp"

#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/radial_power.hpp"
#include "engine/rendering/surface_measures.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace touchtrial::engine {
namespace {

constexpr double kFinestFeltMm = 1.0;
constexpr double kVibrationHz = 250.0;

double tangential_percentile(FieldView field, double share) {
  std::vector<float> pool;
  pool.reserve(field.samples.size());
  for (const FieldSample& sample : field.samples) {
    pool.push_back(static_cast<float>(norm(Vec2{sample.force_x, sample.force_y})));
  }
  return percentile(pool, share);
}

Plane<double> component(FieldView field, float FieldSample::*value) {
  Plane<double> plane(field.geometry.height_px, field.geometry.width_px);
  for (std::size_t i = 0; i < plane.size(); ++i) plane.samples()[i] = field.samples[i].*value;
  return plane;
}

void add_power_shares(FieldView field, FieldStatistics& statistics) {
  const double pitch_mm = field.geometry.pitch_mm;
  std::vector<double> limits_cycles_per_px = {pitch_mm / kFinestFeltMm};
  for (const double speed_mm_per_s : kStrokeSpeedsMmPerS) {
    limits_cycles_per_px.push_back(kVibrationHz / speed_mm_per_s * pitch_mm);
  }
  const std::vector<double> shares =
      power_shares_above(component(field, &FieldSample::force_x),
                         component(field, &FieldSample::force_y), limits_cycles_per_px);
  statistics.share_below_1_mm = shares[0];
  std::copy(shares.begin() + 1, shares.end(), statistics.share_above_250_hz.begin());
}

void check_finite(double tangential, double normal) {
  if (std::isfinite(tangential) && std::isfinite(normal)) return;
  throw std::invalid_argument("field_statistics: the field has samples that are not finite");
}

/// What both models have in common: a lateral force in proportion to the planes of a field.
FieldStatistics statistics_of_planes(FieldView planes, double lateral_gain_n) {
  FieldStatistics statistics;
  statistics.tangential_rms_n = lateral_gain_n * tangential_rms(planes);
  statistics.tangential_p999_n = lateral_gain_n * tangential_percentile(planes, 0.999);
  add_power_shares(planes, statistics);
  return statistics;
}

FieldStatistics paper_statistics(FieldView field, Gains gains) {
  check_finite(tangential_rms(field), normal_rms(field));
  FieldStatistics statistics = statistics_of_planes(field, gains.tangential_n);
  statistics.normal_rms_n = gains.normal_n * normal_rms(field);
  std::vector<float> pool;
  pool.reserve(field.samples.size());
  append_tangential_stiffness(field, 1.0, pool);
  statistics.stiffness_p99_n_per_mm = gains.tangential_n * percentile(pool, 0.99);
  return statistics;
}

FieldStatistics surface_statistics(FieldView field, double mm_per_grey, double wall_n_per_mm) {
  const TextureField relief = relief_of(field);
  const FieldView view = relief.view();
  check_finite(tangential_rms(view), height_rms(view));
  FieldStatistics statistics =
      statistics_of_planes(view, kStatedLoadN * mm_per_grey / field.geometry.pitch_mm);
  statistics.normal_rms_n = wall_n_per_mm * mm_per_grey * height_rms(view);
  std::vector<float> pool;
  pool.reserve(field.coefficients.size());
  append_stiffness_at_load(view, mm_per_grey, wall_n_per_mm, pool);
  statistics.stiffness_p99_n_per_mm = percentile(pool, 0.99);
  return statistics;
}

}  // namespace

FieldStatistics field_statistics(FieldView field, Gains gains, const RenderingOptions& options) {
  if (field.empty()) throw std::invalid_argument("field_statistics: the field is empty");
  if (field.model() == ModelKind::paper) return paper_statistics(field, gains);
  return surface_statistics(field, gains.height_mm, options.stiffness_n_per_mm);
}

}  // namespace touchtrial::engine
