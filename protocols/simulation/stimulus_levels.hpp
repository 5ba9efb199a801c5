/// \file Levels of a study's stimuli on a device, relative to published thresholds for vibrations
/// of a held stylus. Source: docs/perception.md.
#pragma once

#include "device/model/device_model.hpp"
#include "engine/perception/vibration_threshold.hpp"
#include "engine/rendering/texture_field.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "study/study_key.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::simulation {

/// A band of temporal frequencies; the bands are octaves, except the first and the last.
struct LevelBand {
  double from_hz;
  double to_hz;
};
inline constexpr std::array<LevelBand, 7> kLevelBands{{{0.0, 10.0},
                                                       {10.0, 20.0},
                                                       {20.0, 40.0},
                                                       {40.0, 80.0},
                                                       {80.0, 160.0},
                                                       {160.0, 320.0},
                                                       {320.0, 500.0}}};

/// The level of one plane on one device relative to one curve.
struct StimulusLevel {
  std::string device;  ///< name of the model
  engine::ThresholdCurve curve{};
  /// Gain re the detection threshold, dB: the gain at which the default subject model's median
  /// person detects the stimulus beside blank planes in 79.4 % of trials with three intervals.
  /// kNoLevelDb if no gain suffices. For the blank plane: its power re that of a vibration at the
  /// threshold, dB.
  double db = 0.0;
  /// Power in each band re the greater of threshold and blank plane, dB; for the blank plane, re
  /// the threshold.
  std::array<double, kLevelBands.size()> bands_db{};
};
inline constexpr double kNoLevelDb = -100.0;

/// The levels of one plane by device, and for each device by curve in the order of
/// engine::kThresholdCurves.
using PlaneLevels = std::vector<StimulusLevel>;

struct StimulusLevels {
  std::vector<study::StimulusIndex> stimuli;  ///< by class, exemplar and method
  std::vector<PlaneLevels> levels;            ///< of each stimulus
  PlaneLevels blank;                          ///< of the wall without a texture
  /// Whether levels are relative to published curves, not to the laboratory's thresholds on its
  /// device.
  bool provisional = true;
  bool simulated_pilots =
      false;  ///< whether the laboratory's thresholds are those of simulated people
};

/// Level below which `prepare` warns about a stimulus.
inline constexpr double kMinLevelDb = 10.0;

/// The model of the device that a study names, as device::model_of_device; a file is relative to
/// the study's folder.
/// \pre the study names a device
/// \throws StudyError with the place in the study and the remedy if there is no such model
[[nodiscard]] device::DeviceModel device_of(const study::Study& study);

/// The device models for which a study's levels are computed: the study's model, or else all
/// built-in ones.
/// \throws as device_of
[[nodiscard]] std::vector<device::DeviceModel> level_devices(const study::Study& study);

struct FieldLevels {
  std::vector<PlaneLevels> levels;  ///< of each field
  PlaneLevels blank;                ///< of the wall without a texture
};

/// Computes levels. A hand of the default subject model strokes every field and the blank plane on
/// each device, on the same paths. If the study roves gains, the levels are those at the centre of
/// the range. The result depends on all arguments except `jobs`. Takes about 15 ms of one thread
/// for each plane and device.
/// \param fields  at least one, of the study's rendering model
/// \param jobs  threads, >= 1
[[nodiscard]] FieldLevels levels_of_fields(std::span<const engine::FieldWithGains> fields,
                                           const study::Study& study,
                                           const std::vector<device::DeviceModel>& devices,
                                           int jobs, std::uint64_t seed = 1);

/// Overload for a pack.
/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] StimulusLevels levels_of(const study::StudyCodes& key,
                                       const session::StimulusSource& source,
                                       const std::vector<device::DeviceModel>& devices, int jobs,
                                       std::uint64_t seed = 1);

/// \return a short name of a stimulus: its class, with exemplar and method if there are several
[[nodiscard]] std::string name_of_stimulus(const study::Study& study,
                                           const study::StimulusIndex& index);

/// The minimum and maximum level of a plane on a device, over all curves.
struct LevelRange {
  double low_db = 0.0;
  double high_db = 0.0;
};
[[nodiscard]] LevelRange range_on(const PlaneLevels& levels, const std::string& device);

}  // namespace touchtrial::simulation
