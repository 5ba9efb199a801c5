#include "engine/rendering/gains.hpp"

#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/surface_gains.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

constexpr double kSlackOfGains = 1e-9;  // relative; what is over the budget by less is on it

/// One of the two forces that a gain scales.
struct Channel {
  double (*rms)(FieldView) noexcept;
  void (*append_stiffness)(FieldView, double, std::vector<float>&);
  std::optional<double> explicit_gain;
};

struct ChannelGains {
  std::vector<double> of_field;
  bool over_budget = false;
};

std::vector<double> rms_of_fields(std::span<const FieldView> fields, const Channel& channel) {
  std::vector<double> rms;
  for (const FieldView& field : fields) rms.push_back(channel.rms(field));
  if (!std::ranges::all_of(rms, [](double value) { return std::isfinite(value); })) {
    throw std::invalid_argument("choose_gains: a field has samples that are not finite");
  }
  return rms;
}

/// The pooled stiffness of all fields that are not flat, each scaled.
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
  const std::vector<double> rms = rms_of_fields(fields, channel);
  const bool equal_rms = options.equalise == Equalise::rms;
  ChannelGains gains;
  for (const double value : rms) {
    const double equalising = value > 0.0 ? 1.0 / value : 0.0;
    gains.of_field.push_back(equal_rms ? equalising : 1.0);
  }
  const double stiffness = pooled_stiffness(fields, rms, gains.of_field, channel);
  const double budget = options.texture_stiffness_n_per_mm;
  double factor = stiffness > 0.0 ? budget / stiffness : 0.0;
  if (channel.explicit_gain) {
    factor = *channel.explicit_gain * (equal_rms ? mean_of_nonzero(rms) : 1.0);
    gains.over_budget = factor * stiffness > budget * (1.0 + kSlackOfGains);
  }
  for (double& gain : gains.of_field) gain *= factor;
  return gains;
}

bool is_gain(double gain) {
  return std::isfinite(gain) && gain >= 0.0;
}

void check(std::span<const FieldView> fields, const RenderingOptions& options) {
  if (fields.empty()) throw std::invalid_argument("choose_gains: there is no field");
  const double budget = options.texture_stiffness_n_per_mm;
  if (!std::isfinite(budget) || budget <= 0.0) {
    throw std::invalid_argument("choose_gains: the budget must be a finite number > 0");
  }
  if (options.gains && !(is_gain(options.gains->tangential_n) && is_gain(options.gains->normal_n) &&
                         is_gain(options.gains->height_mm))) {
    throw std::invalid_argument("choose_gains: explicit gains must be finite numbers >= 0");
  }
  if (!std::ranges::all_of(
          fields, [&](const FieldView& field) { return field.model() == options.model; })) {
    throw std::invalid_argument("choose_gains: a field is of another rendering model");
  }
}

}  // namespace

StudyGains choose_gains(std::span<const FieldView> fields, const RenderingOptions& options) {
  check(fields, options);
  if (options.model == ModelKind::surface) return choose_surface_gains(fields, options);
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

}  // namespace touchtrial::engine
