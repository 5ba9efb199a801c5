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

double tangential_percentile(SampledView field, double share) {
  std::vector<float> pool(field.samples.size());
  std::ranges::transform(field.samples, pool.begin(), [](const FieldSample& sample) {
    const double x = sample.force_x;
    const double y = sample.force_y;
    return static_cast<float>(std::sqrt(x * x + y * y));
  });
  return percentile({&pool, 1}, share);
}

ForceField<double> force_planes(SampledView field) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  ForceField<double> force{Plane<double>(height, width), Plane<double>(height, width)};
  for (std::size_t i = 0; i < field.samples.size(); ++i) {
    force.x.samples()[i] = field.samples[i].force_x;
    force.y.samples()[i] = field.samples[i].force_y;
  }
  return force;
}

void add_power_shares(SampledView field, FieldStatistics& statistics) {
  const double pitch_mm = field.geometry.pitch_mm;
  std::vector<double> limits_cycles_per_px = {pitch_mm / kFinestFeltMm};
  for (const double speed_mm_per_s : kStrokeSpeedsMmPerS) {
    limits_cycles_per_px.push_back(kVibrationHz / speed_mm_per_s * pitch_mm);
  }
  const std::vector<double> shares = power_shares_above(field, limits_cycles_per_px);
  statistics.share_below_1_mm = shares[0];
  std::copy(shares.begin() + 1, shares.end(), statistics.share_above_250_hz.begin());
}

}  // namespace

LateralField lateral_field(FieldView field, Gains gains) {
  if (field.empty()) throw std::invalid_argument("lateral_field: the field is empty");
  const ModelParts parts = parts_of(field.model);
  return {force_planes(parts.sampled(field).view()), parts.n_per_grey(field, gains)};
}

FieldStatistics field_statistics(FieldView field, Gains gains, const RenderingOptions& options) {
  if (field.empty()) throw std::invalid_argument("field_statistics: the field is empty");
  return parts_of(field.model).statistics(field, gains, options);
}

FieldStatistics lateral_statistics(SampledView field, double n_per_grey) {
  FieldStatistics statistics;
  statistics.tangential_rms_n = n_per_grey * tangential_rms(field);
  statistics.tangential_p999_n = n_per_grey * tangential_percentile(field, 0.999);
  add_power_shares(field, statistics);
  return statistics;
}

void require_finite_rms(double tangential, double normal) {
  if (std::isfinite(tangential) && std::isfinite(normal)) return;
  throw std::invalid_argument("field_statistics: the field has samples that are not finite");
}

}  // namespace touchtrial::engine
