#include "engine/rendering/paper_model.hpp"

#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/model_parts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace touchtrial::engine {
namespace {

/// Texture values at a point between pixels.
struct Texture {
  double surface;
  double force_x;
  double force_y;
};

Texture texture_at(const FieldView& field, double x_mm, double y_mm) noexcept {
  const PlaneGeometry& plane = field.geometry;
  const Vec2 px = plane.to_px(x_mm, y_mm);
  const double x = std::clamp(px.x, 0.0, plane.width_px - 1.0);
  const double y = std::clamp(px.y, 0.0, plane.height_px - 1.0);
  const auto left = static_cast<int>(x);
  const auto top = static_cast<int>(y);
  const std::size_t right_step = left + 1 < plane.width_px ? 1 : 0;
  const std::size_t down_step = top + 1 < plane.height_px ? plane.width_px : 0;
  const FieldSample* corner =
      field.samples.data() + static_cast<std::size_t>(top) * plane.width_px + left;
  const double to_right = x - left;
  const double to_down = y - top;
  const auto mixed = [&](float FieldSample::*value) {
    const double a = corner->*value;
    const double b = corner[right_step].*value;
    const double c = corner[down_step].*value;
    const double d = corner[down_step + right_step].*value;
    const double upper = a + to_right * (b - a);
    const double lower = c + to_right * (d - c);
    return upper + to_down * (lower - upper);
  };
  return {mixed(&FieldSample::surface), mixed(&FieldSample::force_x), mixed(&FieldSample::force_y)};
}

}  // namespace

PaperModel::PaperModel(FieldView field, const RenderingOptions& options, Gains gains) noexcept
    : field_(field),
      stiffness_n_per_mm_(options.stiffness_n_per_mm),
      damping_n_s_per_mm_(options.damping_n_s_per_mm),
      reference_grey_(options.reference_grey),
      max_force_n_(options.max_force_n),
      gains_(gains) {}

Vec3 PaperModel::force_n(Vec3 position_mm, Vec3 velocity_mm_s) const noexcept {
  if (!is_finite(position_mm) || !is_finite(velocity_mm_s)) return {};
  double elastic_n = -stiffness_n_per_mm_ * position_mm.z;
  Texture texture{reference_grey_, 0.0, 0.0};
  if (field_.geometry.contains(position_mm.x, position_mm.y) && !field_.samples.empty()) {
    if (is_out_of_reach(elastic_n)) return {};
    texture = texture_at(field_, position_mm.x, position_mm.y);
    elastic_n += gains_.normal_n * (texture.surface - reference_grey_);
  }
  const double normal_n = elastic_n - damping_n_s_per_mm_ * velocity_mm_s.z;
  if (!(elastic_n > 0.0 && normal_n > 0.0)) return {};
  return limited_in_norm(
      {gains_.tangential_n * texture.force_x, gains_.tangential_n * texture.force_y, normal_n},
      max_force_n_);
}

bool PaperModel::is_out_of_reach(double wall_n) const noexcept {
  if (reference_grey_ == 0.0 && wall_n <= 0.0) return true;
  return wall_n + gains_.normal_n * (field_.highest - reference_grey_) <= 0.0;
}

// What make_texture_field, choose_gains, field_statistics and lateral_field do for this model.

namespace {

constexpr double kSlackOfGains = 1e-9;  // relative; less above the budget is rounding

/// The filter and the force depend on differences only, so the level of 128 is added last and costs
/// no digits.
TextureField field_of_paper(Plane<double> smooth, const RenderingOptions& options) {
  const ForceField<double> force = tangential_force(smooth, options.neighbourhood);
  Plane<FieldSample> samples(smooth.height(), smooth.width());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.samples()[i] = {static_cast<float>(128.0 + smooth.samples()[i]),
                            static_cast<float>(force.x.samples()[i]),
                            static_cast<float>(force.y.samples()[i])};
  }
  return {{options.pitch_mm, smooth.height(), smooth.width()}, std::move(samples)};
}

/// One of the two forces that have a gain.
struct Channel {
  double (*rms)(FieldView) noexcept;
  void (*append_stiffness)(FieldView, double, std::vector<float>&);
  std::optional<double> explicit_gain;
};

struct ChannelGains {
  std::vector<double> of_field;
  bool over_budget = false;
};

/// The pooled stiffness of all fields that are not flat, each with its scale.
double pooled_stiffness(std::span<const FieldView> fields, const std::vector<double>& rms,
                        const std::vector<double>& scale, const Channel& channel) {
  std::size_t pixels = 0;
  for (const FieldView& field : fields) pixels += field.samples.size();
  std::vector<float> pool;
  pool.reserve(pixels);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (rms[i] > 0.0) channel.append_stiffness(fields[i], scale[i], pool);
  }
  return typical_stiffness(pool);
}

ChannelGains channel_gains(std::span<const FieldView> fields, const RenderingOptions& options,
                           const Channel& channel) {
  std::vector<double> rms;
  for (const FieldView& field : fields) rms.push_back(channel.rms(field));
  ChannelGains gains{equalising_factors(rms, options.equalise)};
  const double stiffness = pooled_stiffness(fields, rms, gains.of_field, channel);
  const double budget = options.texture_stiffness_n_per_mm;
  double factor = stiffness > 0.0 ? budget / stiffness : 0.0;
  if (channel.explicit_gain) {
    factor = explicit_factor(*channel.explicit_gain, rms, options.equalise);
    gains.over_budget = factor * stiffness > budget * (1.0 + kSlackOfGains);
  }
  for (double& gain : gains.of_field) gain *= factor;
  return gains;
}

StudyGains gains_of_paper(std::span<const FieldView> fields, const RenderingOptions& options) {
  Channel tangential{tangential_rms, append_tangential_stiffness, std::nullopt};
  Channel normal{normal_rms, append_normal_stiffness, std::nullopt};
  if (options.gains) {
    tangential.explicit_gain = options.gains->tangential_n;
    normal.explicit_gain = options.gains->normal_n;
  }
  const ChannelGains along = channel_gains(fields, options, tangential);
  const ChannelGains across = channel_gains(fields, options, normal);
  StudyGains gains;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    gains.of_field.push_back({along.of_field[i], across.of_field[i]});
  }
  gains.over_budget = along.over_budget || across.over_budget;
  return gains;
}

FieldStatistics statistics_of_paper(FieldView field, Gains gains,
                                    const RenderingOptions& /*options*/) {
  require_finite_rms(tangential_rms(field), normal_rms(field));
  FieldStatistics statistics = lateral_statistics(field, gains.tangential_n);
  statistics.normal_rms_n = gains.normal_n * normal_rms(field);
  std::vector<float> pool;
  pool.reserve(field.samples.size());
  append_tangential_stiffness(field, 1.0, pool);
  statistics.stiffness_p99_n_per_mm = gains.tangential_n * percentile(pool, 0.99);
  return statistics;
}

LateralField lateral_of_paper(FieldView field, Gains gains) {
  return {force_planes(field), gains.tangential_n};
}

}  // namespace

ModelParts paper_parts() noexcept {
  return {field_of_paper, gains_of_paper, statistics_of_paper, lateral_of_paper};
}

}  // namespace touchtrial::engine
