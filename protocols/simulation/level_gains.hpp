/// \file The gains with which stimuli have the level that a study states.
/// Source: docs/perception.md, "A study's level".
#pragma once

#include "device/model/device_model.hpp"
#include "engine/perception/vibration_threshold.hpp"
#include "engine/rendering/gains.hpp"
#include "protocols/simulation/stimulus_levels.hpp"
#include "study/study_key.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::simulation {

/// Stiffer textures feel "alive" at a servo rate of 1 kHz, N/mm: between 0.33 at 250 Hz and 0.90 at
/// 40 kHz, linearly in the logarithm of the rate. Choi and Tan 2004.
inline constexpr double kCleanStiffnessNPerMm = 0.48;

/// By what thresholds a level is meant.
struct LevelCurve {
  engine::ThresholdCurve curve = engine::ThresholdCurve::israr_2006;
  /// How much less sensitive the people of this laboratory were on this device, dB; nothing: it has
  /// measured no thresholds.
  std::optional<double> pilots_db;
  bool simulated_pilots = false;  ///< those were simulated people

  /// \return a level by the curve as one by this
  [[nodiscard]] double level(double db) const noexcept { return db - pilots_db.value_or(0.0); }
};

/// Turns levels by the curve into levels by the laboratory's own thresholds.
/// \pre curve.pilots_db
void apply(const LevelCurve& curve, StimulusLevels& levels);

struct LevelledGains {
  engine::StudyGains gains;
  /// That the level is out of reach, and what would give more; none if it is reached.
  std::vector<std::string> remarks;
};

/// The weakest stimulus gets the study's level, by one factor on all gains; with Equalise::level,
/// every stimulus gets it, or the level that the weakest can have. Gains are never larger than
/// those at which textures are as stiff as the study's budget, kCleanStiffnessNPerMm or the device
/// allow, or the motors could not hold the forces beside a press of kStatedLoadN. Flat stimuli do
/// not count.
/// \param fields  of key.stimuli
/// \param device  the study's
/// \param jobs  threads, >= 1
/// \pre the study has a level
[[nodiscard]] LevelledGains gains_at_level(const study::StudyCodes& key,
                                           std::span<const engine::FieldView> fields,
                                           const device::DeviceModel& device,
                                           const LevelCurve& curve, int jobs);

}  // namespace touchtrial::simulation
