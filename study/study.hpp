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
/// The study file's word for a rendering model.
[[nodiscard]] std::string_view name_of(engine::ModelKind model);
/// What follows a presentation that was interrupted by a fault, a comfort stop, or the program's
/// end.
enum class OnInterruption { repeat, leave_out, restart_block };

/// The speeds of strokes that the instructions ask for, mm/s. Source: docs/running-sessions.md.
inline constexpr double kSlowestMmS = 50.0;
inline constexpr double kFastestMmS = 150.0;
/// The forces across the plane that they ask for, N.
inline constexpr double kLightestN = 0.5;
inline constexpr double kStrongestN = 0.8;

/// When a trial is valid: fixed before outcomes are seen. Forces differ between textures, and so do
/// the path and the contact that forces bend. Whether these are within their limits is therefore
/// known only after unblinding; whether the exploration was long enough is stored in clear, and so
/// is what the hand did by itself (record::HandWindows).
struct ValidityRule {
  double least_exploring_s = 5.0;  ///< from landing to the last sample
  double least_contact_s = 5.0;
  double least_path_mm = 300.0;   ///< in contact
  double least_median_n = 0.2;    ///< of the norm of the force in contact
  double largest_median_n = 2.0;  ///< of the same
  double saturated_share = 0.01;  ///< of the samples in contact; exclusive

  friend bool operator==(const ValidityRule&, const ValidityRule&) = default;
};

/// What the hand does at the plane before its presentation can be answered. The usual one is half a
/// second at the slowest stroke that the instructions ask for. Source:
/// docs/decisions/README.md, decision 63.
struct LeastTouch {
  double contact_s = 0.5;
  double path_mm = 25.0;  ///< along the plane

  friend bool operator==(const LeastTouch&, const LeastTouch&) = default;
};

/// The study file's "trials" object.
struct TrialOptions {
  int repeats = 5;  ///< presentations of each class (and method) per participant, >= 1
  TrialOrder order = TrialOrder::shuffled;
  double explore_limit_s = 60.0;  ///< > 0
  OnTimeout on_timeout = OnTimeout::fade;
  int practice = 0;              ///< presentations in a practice round
  int break_every = 0;           ///< trials between breaks; 0: none
  double break_after_min = 0.0;  ///< time between breaks, ended by the next trial's end; 0: none
  int catch_trials = 0;  ///< unscored presentations of a plane without texture, among the others
  int lead_in = 0;       ///< unscored presentations at the start of each block
  Blocks blocks = Blocks::by_method;
  int max_run = 0;  ///< maximum number of presentations of one class in a row; 0: no limit
  /// Each presentation's gain is drawn from a range so wide, which ends at the pack's; 0: not.
  double rove_db = 0.0;
  OnInterruption on_interruption = OnInterruption::repeat;
  double resume_within_h = 24.0;  ///< how long an interrupted session can still be resumed, > 0
  ValidityRule validity{};
  LeastTouch answer_after{};  ///< zeros: an answer needs no touch

  /// A stimulus's own gain, about which presentations are roved, dB re the pack's.
  [[nodiscard]] double own_gain_db() const noexcept { return -rove_db / 2.0; }

  friend bool operator==(const TrialOptions&, const TrialOptions&) = default;
};

/// How strong the weakest stimulus is to be; with Equalise::level, every one.
struct WantedLevel {
  static constexpr double kMaxDb = 40.0;
  double db = 0.0;    ///< above the detection threshold on the study's device, 0 .. kMaxDb
  std::string curve;  ///< name of a curve of thresholds, or a database of pilots; not empty

  friend bool operator==(const WantedLevel&, const WantedLevel&) = default;
};

/// A study as read from its file.
struct Study {
  std::string name;
  const Protocol* protocol = nullptr;  ///< never null in a study read from a file
  std::shared_ptr<const Task> task;    ///< likewise
  std::vector<StudyClass> classes;     ///< >= 1, labels unique
  std::vector<StudyMethod> methods;    ///< >= 1, labels unique
  engine::RenderingOptions rendering;
  std::string device;  ///< model of the device that the forces are for, or its file; may be empty
  std::optional<WantedLevel> level;  ///< from which the gains follow; nothing: from `rendering`
  TrialOptions trials;
  PracticePlan practice;
  SessionPlan session;
  VisitPlan visits;
  GroupPlan groups;
  Registration registration;
  /// Whether the experimenter must not know what is presented either.
  bool double_blind = true;
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< image paths are relative to this folder
  std::string source;            ///< the file's name, for errors
  std::string text;              ///< the file's content

  /// The protocol's name, as in the file.
  [[nodiscard]] std::string protocol_name() const;
  /// The number of methods that are presented; these are the first ones in the file.
  [[nodiscard]] int presented_methods() const;
  /// Their labels with commas between them.
  [[nodiscard]] std::string presented_labels() const;
  /// The class of an index. Practice classes follow the study's.
  /// \throws std::out_of_range if there is no such class
  [[nodiscard]] const StudyClass& class_at(int class_index) const;
  /// Whether a class is one of practice.
  [[nodiscard]] bool is_practised(int class_index) const noexcept;
  /// The number of scored presentations of one participant, over all visits.
  [[nodiscard]] int scored_trials() const;
  /// The number of visits without which a participant does not count: all, or the first if the
  /// registered analysis has that alone.
  [[nodiscard]] int visits_needed() const;
  /// Whether a visit enters the analysis that decides.
  [[nodiscard]] bool decides(int visit) const;
};

/// The usual test of a difference of methods: crossover if two methods are presented one after the
/// other, else sign flips.
[[nodiscard]] RegisteredTest usual_test_of(const Study& study);

/// Reads a study file strictly: refuses unknown keys, wrong types and impossible values.
/// \throws StudyError with the file, the JSON pointer, and the nearest known key or value
[[nodiscard]] Study load_study(const std::filesystem::path& path);

/// Reads a study from text, with the same errors.
/// \param source  name of the text's origin, for error messages
[[nodiscard]] Study parse_study(std::string_view text, const std::filesystem::path& folder,
                                const std::string& source);

}  // namespace touchtrial::study
