#include "protocols/simulation/level_gains.hpp"

#include "engine/rendering/field_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <fmt/format.h>

namespace touchtrial::simulation {
namespace {

using Fields = std::vector<engine::FieldWithGains>;

/// Tolerance of a stimulus's level, dB.
constexpr double kToleranceDb = 0.05;
/// The maximum number of corrections of gains, which are needed because the response of a hand is
/// not quite linear.
constexpr int kMaxAttempts = 4;

/// The budget of a study's textures on its device, N/mm.
double stiffness_bound(const engine::RenderingOptions& rendering,
                       const device::DeviceModel& device) {
  const double bound = std::min(rendering.texture_stiffness_n_per_mm, kCleanStiffnessNPerMm);
  return device.max_stiffness_n_per_mm > 0.0 ? std::min(bound, device.max_stiffness_n_per_mm)
                                             : bound;
}

/// The rms lateral force that a device's motors can sustain in addition to a press.
double motor_bound_n(const device::DeviceModel& device) {
  if (!(device.continuous_force_n > engine::kReferenceLoadN)) {
    return std::numeric_limits<double>::infinity();
  }
  return std::sqrt(device.continuous_force_n * device.continuous_force_n -
                   engine::kReferenceLoadN * engine::kReferenceLoadN);
}

/// The fields with the maximum gains that stiffness and motors allow.
Fields fields_at_max_gains(std::span<const engine::FieldView> views,
                           engine::RenderingOptions rendering, const device::DeviceModel& device,
                           double stiffness_n_per_mm) {
  rendering.texture_stiffness_n_per_mm = stiffness_n_per_mm;
  const engine::StudyGains gains = engine::choose_gains(views, rendering);
  Fields fields;
  double strongest_n = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    fields.push_back({views[i], gains.per_field[i]});
    strongest_n = std::max(
        strongest_n,
        engine::field_statistics(views[i], gains.per_field[i], rendering).tangential_rms_n);
  }
  const double factor = std::min(1.0, motor_bound_n(device) / strongest_n);
  if (strongest_n > 0.0) {
    for (engine::FieldWithGains& field : fields) field.gains = engine::scaled(field.gains, factor);
  }
  return fields;
}

/// Computes levels of one study's fields on its device.
class LevelMeter {
 public:
  LevelMeter(const study::Study& study, const device::DeviceModel& device, const LevelCurve& curve,
             int jobs)
      : study_(study), devices_{device}, curve_(curve), jobs_(jobs) {}

  /// \return the level of each field; kNoLevelDb for a flat one
  [[nodiscard]] std::vector<double> levels(const Fields& fields) const {
    std::vector<double> levels;
    for (const PlaneLevels& plane : levels_of_fields(fields, study_, devices_, jobs_).levels) {
      const auto level = std::ranges::find(plane, curve_.curve, &StimulusLevel::curve);
      levels.push_back(level->db == kNoLevelDb ? kNoLevelDb : curve_.level(level->db));
    }
    return levels;
  }

 private:
  const study::Study& study_;
  std::vector<device::DeviceModel> devices_;
  LevelCurve curve_;
  int jobs_;
};

/// \return the index of the weakest stimulus; nothing if all are flat
std::optional<std::size_t> index_of_weakest(const std::vector<double>& levels) {
  std::optional<std::size_t> index;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i] == kNoLevelDb) continue;
    if (!index || levels[i] < levels[*index]) index = i;
  }
  return index;
}

/// The changes that would raise the level, and the resulting levels.
std::string remedies(const study::Study& study, std::span<const engine::FieldView> views,
                     const device::DeviceModel& device, const LevelMeter& meter) {
  std::string text;
  if (study.trials.rove_db > 0.0) {
    text = fmt::format("/trials/rove_db 0 gives {:.1f} dB more", -study.trials.centre_gain_db());
  }
  const auto add = [&](const std::string& change, const Fields& fields) {
    const std::vector<double> levels = meter.levels(fields);
    const auto place = index_of_weakest(levels);
    if (!place) return;
    text += fmt::format("{}{} gives {:.1f} dB", text.empty() ? "" : ", ", change, levels[*place]);
  };
  engine::RenderingOptions stiffest = study.rendering;
  stiffest.texture_stiffness_n_per_mm = kCleanStiffnessNPerMm;
  const double bound = stiffness_bound(study.rendering, device);
  const double clean_bound = stiffness_bound(stiffest, device);
  if (clean_bound > bound) {
    add(fmt::format("/rendering/texture_stiffness_n_per_mm {:g}", clean_bound),
        fields_at_max_gains(views, study.rendering, device, clean_bound));
  }
  constexpr double kWider = 2.0;
  std::vector<engine::FieldView> wider(views.begin(), views.end());
  for (engine::FieldView& view : wider) view.geometry.pitch_mm *= kWider;
  // The filter keeps its width in pixels, because the fields are not extracted again.
  add(fmt::format("/rendering/pitch_mm {:g} and filter_mm {:g} with crops of half the side",
                  kWider * study.rendering.pitch_mm, kWider * study.rendering.filter_mm),
      fields_at_max_gains(wider, study.rendering, device, bound));
  return text;
}

}  // namespace

void apply(const LevelCurve& curve, StimulusLevels& levels) {
  for (PlaneLevels& plane : levels.levels) {
    for (StimulusLevel& level : plane) {
      const auto chosen = std::ranges::find_if(plane, [&](const StimulusLevel& other) {
        return other.device == level.device && other.curve == curve.curve;
      });
      if (level.curve != curve.curve) level.db = chosen->db;
    }
    for (StimulusLevel& level : plane) {
      if (level.db != kNoLevelDb) level.db = curve.level(level.db);
    }
  }
  levels.provisional = levels.simulated_pilots = curve.simulated_pilots;
}

GainsAtLevel gains_at_level(const study::StudyCodes& key, std::span<const engine::FieldView> fields,
                            const device::DeviceModel& device, const LevelCurve& curve, int jobs) {
  const study::Study& study = key.study;
  const double stated_db = study.level.value().db;
  const double bound = stiffness_bound(study.rendering, device);
  const LevelMeter meter(study, device, curve, jobs);
  const Fields max_fields = fields_at_max_gains(fields, study.rendering, device, bound);
  const std::vector<double> max_levels = meter.levels(max_fields);
  GainsAtLevel result;
  Fields chosen_fields = max_fields;
  std::vector<double> factors(fields.size(), 1.0);
  std::vector<double> levels = max_levels;
  const auto weakest_index = index_of_weakest(max_levels);
  const bool is_equalised = study.rendering.equalise == engine::Equalise::level;
  const double target_db =
      weakest_index ? std::min(stated_db, max_levels[*weakest_index]) : stated_db;
  for (int attempt = 0; weakest_index && attempt < kMaxAttempts; ++attempt) {
    const double weakest_db = levels[*index_of_weakest(levels)];
    double max_error_db = 0.0;
    for (std::size_t i = 0; i < chosen_fields.size(); ++i) {
      if (levels[i] == kNoLevelDb) continue;
      const double more_db = target_db - (is_equalised ? levels[i] : weakest_db);
      factors[i] = std::min(1.0, factors[i] * std::pow(10.0, more_db / 20.0));
      chosen_fields[i].gains = engine::scaled(max_fields[i].gains, factors[i]);
      max_error_db = std::max(max_error_db, std::abs(more_db));
    }
    if (max_error_db < kToleranceDb) break;
    levels = meter.levels(chosen_fields);
  }
  for (const engine::FieldWithGains& field : chosen_fields) {
    result.gains.per_field.push_back(field.gains);
  }
  if (weakest_index && max_levels[*weakest_index] < stated_db - kToleranceDb) {
    result.remarks.push_back(fmt::format(
        "/rendering/gains/level_db: {:g} dB by {} cannot be reached on {}: {} has {:.1f} dB at "
        "{:g} N/mm; {}",
        stated_db, study.level->curve, device.name,
        name_of_stimulus(study, key.stimuli[*weakest_index].stimulus), max_levels[*weakest_index],
        bound, remedies(study, fields, device, meter)));
  }
  return result;
}

}  // namespace touchtrial::simulation
