/// \file The parameters of simulated participants, as stored in subject files.
/// Format: docs/planning.md and config/schema/subject.schema.json.
#pragma once

#include "device/drivers/simulated/hand_on_tip.hpp"
#include "device/model/device_model.hpp"
#include "engine/perception/vibration_threshold.hpp"
#include "protocols/simulation/subject_changes.hpp"
#include "study/study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::simulation {

/// A preference for the picture of one class, independent of felt features.
struct ClassBias {
  std::string label;
  double log_odds = 0.0;

  friend bool operator==(const ClassBias&, const ClassBias&) = default;
};

/// A population of participants: exploration, perception, errors, answers, and differences between
/// them. `Individual` (protocols/simulation/felt_decision.hpp) draws one participant.
struct SubjectModel {
  /// The threshold curve for accelerations of the tip; empty: a flat sense of the servo's forces,
  /// with a threshold of 2 mN.
  std::optional<engine::ThresholdCurve> sense{};
  /// Differences between participants: standard deviation of all their thresholds, dB, >= 0. No
  /// effect on the flat sense.
  double threshold_spread_db = 0.0;
  /// Standard deviation of the independent noise of each felt log intensity, >= 0.
  double feature_noise = 0.0;
  /// Standard deviation of the noise common to all felt log intensities of a presentation, >= 0. It
  /// makes the strength of a texture uncertain, regardless of its pattern.
  double common_noise = 0.0;
  /// Differences between participants: both noises times exp(spread * z), z standard normal.
  double feature_noise_spread = 0.0;
  double lapse = 0.0;  ///< probability of a random answer, 0 .. 1
  /// Standard deviation between participants of the log odds of a lapse, >= 0.
  double lapse_spread = 0.0;
  /// Preference for the first picture over the last, log odds, decreasing linearly.
  double position_bias = 0.0;
  double position_bias_spread = 0.0;  ///< standard deviation between participants, >= 0
  std::vector<ClassBias> class_bias{};
  /// Standard deviation between participants of the preference for each class, >= 0.
  double class_bias_spread = 0.0;
  /// Pairs of labels that the participants confuse: each texture is matched to the other's picture.
  std::vector<std::pair<std::string, std::string>> label_swap{};
  double explore_s = 10.0;  ///< exploration time of a trial, > 0
  double push_n = 0.7;      ///< force towards the plane, > 0
  double slowest_mm_s = 50.0;
  double fastest_mm_s = 150.0;
  device::HandKind hand = device::HandKind::point_mass;
  /// Differences between participants: stiffness, damping and mass of the hand times
  /// exp(hand_spread * z), each with its own z; in [0, 1].
  double hand_spread = 0.0;
  int training_passes = 8;  ///< explorations of each stimulus before the first trial, >= 1
  Training training = Training::shared;
  /// Standard deviation of a participant's memory error in every log intensity of a stimulus, >= 0.
  double memory_noise = 0.0;
  Learning learning{};
  /// Differences between the blocks and visits of a participant: standard deviation of the natural
  /// logarithm of the noise, >= 0.
  double period_noise_spread = 0.0;
  SerialDependence serial{};
  Fatigue fatigue{};
  /// The model of thinking time. Empty: uniform from 0.8 to 4 s, independent of felt features.
  std::optional<ThoughtTime> thought{};
  /// The function by which participants answer. Empty: answers depend on felt features.
  std::optional<GivenFunction> given_function{};

  /// The device; ideal unless a command or the study names one. Not in the file.
  device::DeviceModel device{};

  std::string source{};  ///< the file, for error messages

  /// Checks that the study has every label.
  /// \throws StudyError with this file's JSON pointer if it lacks one
  void check_labels(const study::Study& study) const;
};

/// \return the device name that sessions of this subject record (record::SessionOpening):
///   device::simulated_device_name, or "given-function" with a given_function
[[nodiscard]] std::string recorded_device(const SubjectModel& model);

/// \return the name in subject files: "flat", "israr_2006" or "tan_1994"
[[nodiscard]] std::string_view name_of_sense(
    const std::optional<engine::ThresholdCurve>& sense) noexcept;

/// \return config/subjects/default.json, as built into the program
[[nodiscard]] SubjectModel default_subject();

/// Reads a subject file strictly: refuses unknown keys, wrong types and impossible values. Missing
/// keys have the defaults above.
/// \throws StudyError with the file, the JSON pointer, and the nearest known key or value
/// \throws FileError if the file cannot be read
[[nodiscard]] SubjectModel load_subject_model(const std::filesystem::path& path);

/// Reads a subject file's text.
/// \param source  names the origin in errors
/// \throws StudyError as load_subject_model
[[nodiscard]] SubjectModel parse_subject_model(std::string_view text, const std::string& source);

/// The text of a subject file with every key, except for an empty `thought` or `given_function`.
/// parse_subject_model reads it back as the same model except for the source, because numbers have
/// all their digits. Indented; ends with a line feed.
[[nodiscard]] std::string subject_model_json(const SubjectModel& model);

}  // namespace touchtrial::simulation
