#include "engine/rendering/field_statistics.hpp"

#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/radial_power.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace touchtrial {
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

double stiffness_percentile(FieldView field, double share) {
  std::vector<float> pool;
  pool.reserve(field.samples.size());
  append_tangential_stiffness(field, 1.0, pool);
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

}  // namespace

FieldStatistics field_statistics(FieldView field, Gains gains) {
  if (field.samples.empty()) throw std::invalid_argument("field_statistics: the field is empty");
  FieldStatistics statistics;
  statistics.tangential_rms_n = gains.tangential_n * tangential_rms(field);
  statistics.normal_rms_n = gains.normal_n * normal_rms(field);
  if (!std::isfinite(statistics.tangential_rms_n) || !std::isfinite(statistics.normal_rms_n)) {
    throw std::invalid_argument("field_statistics: the field has samples that are not finite");
  }
  statistics.tangential_p999_n = gains.tangential_n * tangential_percentile(field, 0.999);
  statistics.stiffness_p99_n_per_mm = gains.tangential_n * stiffness_percentile(field, 0.99);
  add_power_shares(field, statistics);
  return statistics;
}

}  // namespace touchtrial
