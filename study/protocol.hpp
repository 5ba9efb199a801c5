/// \file The interface of a protocol, which defines its part of the study file, the stimuli and the
/// questions. The runner, the store, the window and the exports use a protocol only through
/// this interface. How to write one: docs/add-a-protocol.md.
#pragma once

#include "core/strict_json.hpp"
#include "study/ask.hpp"
#include "study/order.hpp"
#include "study/study.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::study {

/// One round of practice.
struct Practice {
  std::vector<std::string> labels;  ///< of the alternatives, by position
  std::vector<Trial> trials;        ///< their `right` is a position; empty: no practice
  int criterion = 0;  ///< right answers that end practice; 0: practice ends after one round
  int rounds = 0;     ///< maximum
};

/// The fields that trials may present.
struct Fields {
  /// The methods, which replace the study file's. Each image has a field for each presented method.
  std::vector<StudyMethod> methods;
  std::vector<StimulusIndex> practice{};  ///< fields of practice classes
  std::vector<Plane> mixtures{};          ///< every mix of two fields that a trial may present
  /// Whether planes are compared with each other and with blank ones. All walls then have the same
  /// height, and gains scale forces.
  bool has_equal_heights = false;
};

/// The participants' task in a study. A protocol creates it from its own section of the study file,
/// whose options it owns. Immutable and thread-safe: every function depends only on these options
/// and its arguments. The argument `study` is the study that owns the task.
class Task {
 public:
  virtual ~Task() = default;

  /// Checks a study after its other sections have been read.
  /// \param file  the study file, used to locate errors
  /// \throws StudyError with the place of the error and the remedy
  virtual void check(const JsonValue& file, const Study& study) const = 0;
  /// The options that a database stores unencrypted: compact JSON that reveals nothing about a
  /// stimulus. The seal commits to it. Empty: none.
  [[nodiscard]] virtual std::string plaintext_settings() const { return {}; }
  /// The name and version of the rule that generates orders; the seal commits to it.
  [[nodiscard]] virtual std::string rule(const Study& study) const = 0;
  /// Warnings of `prepare` about options that are permitted but probably unintended, each with its
  /// place in the study file.
  [[nodiscard]] virtual std::vector<std::string> advice(const Study& /*study*/) const { return {}; }
  /// One participant's number of scored trials at one visit, or at all visits together if these
  /// divide the methods.
  [[nodiscard]] virtual int scored_trials(const Study& study) const = 0;
  /// The number of catch trials in a session whose answers can be right or wrong.
  [[nodiscard]] virtual int answered_catches(const Study& /*study*/) const { return 0; }
  /// The fields of the study. By default, every practice class has a field with the first method.
  [[nodiscard]] virtual Fields fields(const Study& study) const;

  /// The participant's instructions for the trial at a place. All trials of a study ask the same
  /// question.
  [[nodiscard]] virtual TrialQuestion ask(const Study& study, const Place& place) const = 0;
  /// \param study  must outlive the order
  /// \throws StudyError if the study does not permit the order
  [[nodiscard]] virtual std::unique_ptr<Order> order(const Study& study,
                                                     const ScheduleDraw& draw) const = 0;
  /// \param round  from 1; each has the same number of trials
  [[nodiscard]] virtual Practice practice(const Study& study, const ScheduleDraw& draw,
                                          int round) const;
  /// The field whose threshold a track measures, for tables and exports.
  [[nodiscard]] virtual StimulusIndex threshold_field(const Study& /*study*/,
                                                      const Level& /*level*/) const {
    return {};
  }
};

/// A registered protocol.
struct Protocol {
  std::string_view name;     ///< as in the study file's "protocol"
  std::string_view section;  ///< key of its object in the study file; empty: none
  /// Reads that object.
  /// \param section  empty if the file omits it
  /// \throws StudyError with the place of a value that is not accepted
  std::shared_ptr<const Task> (*read)(const std::optional<JsonValue>& section);
  int min_classes = 2;
  int min_methods = 1;
  bool adaptive = false;    ///< whether answers determine later trials
  bool all_methods = true;  ///< whether participants get all methods, or only the first
  /// Returns the schema of that object, in the form of annotated_section(); null: none.
  std::string (*section_schema)() = nullptr;
  /// The registered questions that its analysis answers; a study cannot register another.
  std::span<const Estimand> estimands{};
};

/// Registers a protocol under its name. Call before the first study is read. Not thread-safe.
/// \param protocol  must outlive the program's use of studies
/// \throws std::invalid_argument if the name is already registered
void add_protocol(const Protocol& protocol);

/// \return the protocol of this name, or null if there is none
[[nodiscard]] const Protocol* find_protocol(std::string_view name);

/// All registered protocols, in the order in which they were added.
[[nodiscard]] const std::vector<const Protocol*>& protocols();

/// The order of one participant. It depends only on the study's classes, methods and trial options
/// and on the draw, and is the same on every platform.
/// \param study  must outlive the order
/// \throws StudyError if the study does not permit the order
[[nodiscard]] std::unique_ptr<Order> make_order(const Study& study, const ScheduleDraw& draw);
/// The schedule of that order.
/// \throws StudyError if the study does not permit the order
[[nodiscard]] Schedule make_schedule(const Study& study, const ScheduleDraw& draw);

/// Every field that a study may present, ordered by class, image and method, then the fields of
/// practice. `prepare` builds these fields, and the key has a code for each.
[[nodiscard]] std::vector<StimulusIndex> presented_fields(const Study& study);
/// The place in the study file of a field's image, for errors.
[[nodiscard]] std::string place_of_image(const Study& study, const StimulusIndex& field);

/// The question of a study's trials other than controls.
[[nodiscard]] TrialQuestion trial_question_of(const Study& study);
/// The alternatives of the question; empty for a question with scales.
[[nodiscard]] std::vector<Choice> choices_of(const Study& study);
/// A round of the study's practice.
[[nodiscard]] Practice practice_of(const Study& study, const ScheduleDraw& draw = {},
                                   int round = 1);

/// The label of the picture shown with a trial's question; empty if there is none.
[[nodiscard]] std::string picture_of(const Study& study, const Trial& trial);

/// Whether the choices of a study are its classes in the same order, as a confusion matrix
/// requires.
[[nodiscard]] bool chooses_classes(const Study& study);
/// \param command  the command that needs this, for the message
/// \throws StudyError if chooses_classes is false
void require_choice_of_classes(const Study& study, const std::string& command);

}  // namespace touchtrial::study
