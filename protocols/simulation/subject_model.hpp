/// \file The parameters of simulated participants, read from a subject file and written to one.
/// Format: docs/subject-file.md and config/schema/subject.schema.json.
#pragma once

#include "protocols/design/study.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::simulation {

/// A preference for the picture of one class, whatever is felt.
struct ClassBias {
  std::string label;
  double log_odds = 0.0;

  friend bool operator==(const ClassBias&, const ClassBias&) = default;
};

/// How participants explore, perceive, err and answer, and how they differ (`Individual` in
/// protocols/simulation/felt_decision.hpp draws one of them).
struct SubjectModel {
  /// Standard deviation of the noise on the logarithm of every felt intensity, >= 0.
  double weber = 0.0;
  /// Differences between participants: each has a Weber fraction of weber * exp(spread * z), z
  /// standard normal.
  double weber_spread = 0.0;
  double lapse = 0.0;  ///< probability of a random answer, 0 .. 1
  /// Standard deviation between participants of the log odds of a lapse, >= 0.
  double lapse_spread = 0.0;
  /// Log odds by which the first picture is preferred to the last; falls linearly in between.
  double position_bias = 0.0;
  double position_bias_spread = 0.0;  ///< its standard deviation between participants, >= 0
  std::vector<ClassBias> class_bias;
  /// Standard deviation between participants of the preference for each class, >= 0.
  double class_bias_spread = 0.0;
  /// Pairs of labels whose pictures the participants exchange: each is matched to what the other
  /// feels like.
  std::vector<std::pair<std::string, std::string>> label_swap;
  double explore_s = 10.0;  ///< exploration time of a trial, > 0
  double push_n = 0.7;      ///< force towards the plane, > 0
  double slowest_mm_s = 50.0;
  double fastest_mm_s = 150.0;
  int training_passes = 8;  ///< explorations of each stimulus before the first trial, >= 1

  std::string source;  ///< the file, for error messages

  /// Checks that the study has every label.
  /// \throws StudyError with this file's JSON pointer if it lacks one
  void check_labels(const design::Study& study) const;
};

/// Reads a subject file strictly: refuses unknown keys, wrong types and impossible values. Missing
/// keys have the defaults above.
/// \throws StudyError with the file, the JSON pointer, and the nearest known key or value
/// \throws FileError if the file cannot be read
[[nodiscard]] SubjectModel load_subject_model(const std::filesystem::path& path);

/// Reads a subject file's text.
/// \param source  names the origin in errors
/// \throws StudyError as load_subject_model
[[nodiscard]] SubjectModel parse_subject_model(std::string_view text, const std::string& source);

/// The text of a subject file with every key. parse_subject_model reads it back as the same model
/// except for the source: numbers have all their digits. Indented; ends with a line feed.
[[nodiscard]] std::string subject_model_json(const SubjectModel& model);

}  // namespace touchtrial::simulation
