/// \file The study file: the stimuli, their rendering, and the trials.
/// Format: docs/study-file.md and config/schema/study.schema.json.
#pragma once

#include "engine/extraction_options.hpp"
#include "engine/rendering/rendering_options.hpp"
#include "study/session_plan.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::study {

struct Protocol;
class Task;

/// An extraction method, and its label in tables and files.
struct StudyMethod : engine::ExtractionOptions {
  std::string label;  ///< unique in the study

  friend bool operator==(const StudyMethod&, const StudyMethod&) = default;
};

/// The label of a method without an explicit one: its name, and its control's name if it has one.
[[nodiscard]] std::string default_label(const engine::ExtractionOptions& method);

enum class TrialOrder { shuffled, de_bruijn, uniform, williams };
[[nodiscard]] std::string_view name_of(TrialOrder order);
enum class OnTimeout { fade, no_response };
enum class Blocks { by_method, mixed };
[[nodiscard]] std::string_view name_of(Blocks blocks);
/// The name of a rendering model in the study file.
[[nodiscard]] std::string_view name_of(engine::ModelKind model);
/// What follows a presentation that was interrupted by a fault, a comfort stop or the end of the
/// program.
enum class OnInterruption { repeat, leave_out, restart_block };

/// The range of stroke speeds in the instructions, mm/s. Source: docs/running-sessions.md.
inline constexpr double kMinStrokeMmS = 50.0;
inline constexpr double kMaxStrokeMmS = 150.0;
/// The range of forces normal to the plane in the instructions, N.
inline constexpr double kMinPressureN = 0.5;
inline constexpr double kMaxPressureN = 0.8;

/// The conditions for a valid trial, fixed before outcomes are seen. Force, path and contact depend
/// on the texture, so whether they are within their limits is revealed only after unblinding. The
/// duration of the exploration and the hand's own motion (record::HandWindows) are stored
/// unencrypted.
struct ValidityRule {
  double min_exploring_s = 5.0;  ///< from landing to the last sample
  double min_contact_s = 5.0;
  double min_path_mm = 300.0;  ///< in contact
  double min_median_n = 0.2;   ///< of the norm of the force in contact
  double max_median_n = 2.0;
  double saturated_share = 0.01;  ///< of the samples in contact; exclusive

  friend bool operator==(const ValidityRule&, const ValidityRule&) = default;
};

/// Minimum contact with the plane before its presentation can be answered. The default is half a
/// second at the slowest stroke of the instructions. Source: docs/decisions/README.md,
/// decision 63.
struct MinTouch {
  double contact_s = 0.5;
  double path_mm = 25.0;  ///< along the plane

  friend bool operator==(const MinTouch&, const MinTouch&) = default;
};

/// The study file's "trials" object.
struct TrialOptions {
  int repeats = 5;  ///< presentations of each class (and method) per participant, >= 1
  TrialOrder order = TrialOrder::shuffled;
  double explore_limit_s = 60.0;  ///< > 0
  OnTimeout on_timeout = OnTimeout::fade;
  int practice = 0;              ///< presentations in a practice round
  int break_every = 0;           ///< trials between breaks; 0: none
  double break_after_min = 0.0;  ///< time after which a break follows the current trial; 0: none
  int catch_trials = 0;  ///< unscored presentations of a plane without texture, at random places
  int lead_in = 0;       ///< unscored presentations at the start of each block
  Blocks blocks = Blocks::by_method;
  int max_run = 0;  ///< maximum number of presentations of one class in a row; 0: no limit
  /// Width of the range from which each presentation's gain is drawn. The range ends at the pack's
  /// gain; 0: no roving.
  double rove_db = 0.0;
  OnInterruption on_interruption = OnInterruption::repeat;
  double resume_within_h = 24.0;  ///< time within which an interrupted session can be resumed, > 0
  ValidityRule validity{};
  MinTouch answer_after{};  ///< zeros: an answer needs no touch

  /// The centre of the roved range, dB re the pack's gain.
  [[nodiscard]] double centre_gain_db() const noexcept { return -rove_db / 2.0; }

  friend bool operator==(const TrialOptions&, const TrialOptions&) = default;
};

/// The intended level of the weakest stimulus or, with Equalise::level, of every stimulus.
struct TargetLevel {
  static constexpr double kMaxDb = 40.0;
  double db = 0.0;    ///< above the detection threshold on the study's device, 0 .. kMaxDb
  std::string curve;  ///< name of a curve of thresholds, or a database of pilots; not empty

  friend bool operator==(const TargetLevel&, const TargetLevel&) = default;
};

/// A study as read from its file.
struct Study {
  std::string name;
  const Protocol* protocol = nullptr;  ///< never null in a study read from a file
  std::shared_ptr<const Task> task;    ///< never null in a study read from a file
  std::vector<StudyClass> classes;     ///< >= 1, labels unique
  std::vector<StudyMethod> methods;    ///< >= 1, labels unique
  engine::RenderingOptions rendering;
  std::string device;                ///< device model that limits forces, or its file; may be empty
  std::optional<TargetLevel> level;  ///< determines the gains; empty: `rendering` does
  TrialOptions trials;
  PracticePlan practice;
  SessionPlan session;
  VisitPlan visits;
  GroupPlan groups;
  Registration registration;
  /// Whether the experimenter is blinded, too.
  bool double_blind = true;
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< image paths are relative to this folder
  std::string source;            ///< the file's name, for errors
  std::string text;              ///< the file's content

  /// The protocol's name, as in the file.
  [[nodiscard]] std::string protocol_name() const;
  /// The number of methods that are presented; these are the first ones in the file.
  [[nodiscard]] int presented_methods() const;
  /// The labels of the presented methods, separated by commas.
  [[nodiscard]] std::string presented_labels() const;
  /// The class of an index. Practice classes follow the study's.
  /// \throws std::out_of_range if there is no such class
  [[nodiscard]] const StudyClass& class_at(int class_index) const;
  /// Whether an index is that of a practice class.
  [[nodiscard]] bool is_practice_class(int class_index) const noexcept;
  /// The number of scored presentations of one participant, over all visits.
  [[nodiscard]] int scored_trials() const;
  /// The number of visits that a participant must complete to count: all, or one if the registered
  /// analysis uses only the first.
  [[nodiscard]] int visits_needed() const;
  /// Whether a visit enters the registered analysis.
  [[nodiscard]] bool enters_analysis(int visit) const;
};

/// The default test of a difference between methods: crossover if two methods are presented one
/// after the other, else sign flips.
[[nodiscard]] RegisteredTest default_test_of(const Study& study);

/// Reads a study file strictly: refuses unknown keys, wrong types and impossible values.
/// \throws StudyError with the file, the JSON pointer, and the nearest known key or value
[[nodiscard]] Study load_study(const std::filesystem::path& path);

/// Reads a study from text, with the same errors.
/// \param source  name of the text's origin, for error messages
[[nodiscard]] Study parse_study(std::string_view text, const std::filesystem::path& folder,
                                const std::string& source);

}  // namespace touchtrial::study
