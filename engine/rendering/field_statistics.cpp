#include "engine/rendering/field_statistics.hpp"

#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/model_parts.hpp"

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

void add_power_shares(FieldView field, FieldStatistics& statistics) {
  const double pitch_mm = field.geometry.pitch_mm;
  std::vector<double> limits_cycles_per_px = {pitch_mm / kFinestFeltMm};
  for (const double speed_mm_per_s : kStrokeSpeedsMmPerS) {
    limits_cycles_per_px.push_back(kVibrationHz / speed_mm_per_s * pitch_mm);
  }
  const ForceField<double> force = force_planes(field);
  const std::vector<double> shares = power_shares_above(force.x, force.y, limits_cycles_per_px);
  statistics.share_below_1_mm = shares[0];
  std::copy(shares.begin() + 1, shares.end(), statistics.share_above_250_hz.begin());
}

}  // namespace

LateralField lateral_field(FieldView field, Gains gains) {
  if (field.empty()) throw std::invalid_argument("lateral_field: the field is empty");
  return parts_of(field.model()).lateral(field, gains);
}

FieldStatistics field_statistics(FieldView field, Gains gains, const RenderingOptions& options) {
  if (field.empty()) throw std::invalid_argument("field_statistics: the field is empty");
  return parts_of(field.model()).statistics(field, gains, options);
}

FieldStatistics lateral_statistics(FieldView planes, double n_per_grey) {
  FieldStatistics statistics;
  statistics.tangential_rms_n = n_per_grey * tangential_rms(planes);
  statistics.tangential_p999_n = n_per_grey * tangential_percentile(planes, 0.999);
  add_power_shares(planes, statistics);
  return statistics;
}

ForceField<double> force_planes(FieldView planes) {
  const int height = planes.geometry.height_px;
  const int width = planes.geometry.width_px;
  ForceField<double> force{Plane<double>(height, width), Plane<double>(height, width)};
  for (std::size_t i = 0; i < planes.samples.size(); ++i) {
    force.x.samples()[i] = planes.samples[i].force_x;
    force.y.samples()[i] = planes.samples[i].force_y;
  }
  return force;
}

void require_finite_rms(double tangential, double normal) {
  if (std::isfinite(tangential) && std::isfinite(normal)) return;
  throw std::invalid_argument("field_statistics: the field has samples that are not finite");
}

}  // namespace touchtrial::engine
