/// \file The gains at which stimuli have the level that a study states.
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

/// Stiffness above which textures feel "alive" at a servo rate of 1 kHz, N/mm. It rises
/// from 0.33 at 250 Hz to 0.90 at 40 kHz, linearly in the logarithm of the rate. Choi and Tan 2004.
inline constexpr double kCleanStiffnessNPerMm = 0.48;

/// The thresholds relative to which levels are stated.
struct LevelCurve {
  engine::ThresholdCurve curve = engine::ThresholdCurve::israr_2006;
  /// The laboratory's thresholds of pilots on this device re the curve, dB; empty if none were
  /// measured.
  std::optional<double> pilots_db;
  bool simulated_pilots = false;  ///< whether the pilots were simulated

  /// Converts a level relative to the curve.
  [[nodiscard]] double level(double db) const noexcept { return db - pilots_db.value_or(0.0); }
};

/// Converts levels relative to the curve into levels relative to the laboratory's thresholds.
/// \pre curve.pilots_db
void apply(const LevelCurve& curve, StimulusLevels& levels);

struct GainsAtLevel {
  engine::StudyGains gains;
  /// A warning that the level cannot be reached, with remedies; empty if it is reached.
  std::vector<std::string> remarks;
};

/// Computes the gains at which the weakest stimulus has the study's level, with one factor on all
/// gains; with Equalise::level, every stimulus gets that level, or the highest that the weakest can
/// reach. Gains are limited by the stiffness that the study's budget, kCleanStiffnessNPerMm and the
/// device allow, and by the forces that the motors can sustain in addition to a press of
/// kReferenceLoadN. Flat stimuli are ignored.
/// \param fields  the fields of key.stimuli
/// \param device  the study's device
/// \param jobs  threads, >= 1
/// \pre the study has a level
[[nodiscard]] GainsAtLevel gains_at_level(const study::StudyCodes& key,
                                          std::span<const engine::FieldView> fields,
                                          const device::DeviceModel& device,
                                          const LevelCurve& curve, int jobs);

}  // namespace touchtrial::simulation
