/// \file The interface of a protocol, which decides its part of the study file, what is presented,
/// and what counts as an answer. The runner, the store, the window and the exports know a protocol
/// only by this interface. How to write one: docs/add-a-protocol.md.
#pragma once

#include "core/strict_json.hpp"
#include "study/adaptive_order.hpp"
#include "study/interval_plan.hpp"
#include "study/schedule.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::study {

struct Study;

/// One of the alternatives that a participant chooses between.
struct Choice {
  std::string label;
  std::optional<int> class_index{};  ///< the class whose picture is shown; empty: the label alone
};

/// The options that a protocol reads from its own section of the study file. Immutable once read.
class ProtocolOptions {
 public:
  virtual ~ProtocolOptions() = default;
};

/// The interface of a protocol. Stateless and thread-safe: every function depends only on its
/// arguments.
class Protocol {
 public:
  virtual ~Protocol() = default;

  /// The protocol's name, as in the study file's "protocol".
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;

  /// The key of the protocol's own object in the study file; empty if it has none.
  [[nodiscard]] virtual std::string_view section() const noexcept { return {}; }
  /// Reads that object, or makes the defaults if the file omits it.
  /// \throws StudyError with the place of a value that is not accepted
  [[nodiscard]] virtual std::shared_ptr<const ProtocolOptions> read(
      const std::optional<JsonValue>& section) const;
  /// The options as a database stores them in clear: compact JSON that reveals nothing about a
  /// stimulus. The seal commits to it. Empty: the database stores nothing.
  [[nodiscard]] virtual std::string options_in_clear(const Study& study) const;
  /// Checks a study after its other sections have been read.
  /// \param file  the whole study file, used to locate errors
  /// \throws StudyError with the place of the error and the remedy
  virtual void check(const JsonValue& file, const Study& study) const = 0;

  /// Whether each participant gets all of the study's methods; if not, only the first.
  [[nodiscard]] virtual bool presents_all_methods() const noexcept { return true; }
  /// The number of scored presentations of one participant.
  [[nodiscard]] virtual int scored_trials(const Study& study) const = 0;

  /// The functions of study/schedule.hpp call these, with the same arguments, results
  /// and errors.
  [[nodiscard]] virtual Schedule schedule(const Study& study, const ScheduleDraw& draw) const = 0;
  [[nodiscard]] virtual std::string rule(const Study& study) const = 0;
  /// By default, shuffles the block's presentations again.
  [[nodiscard]] virtual std::vector<Presentation> restarted_block(const Study& study,
                                                                  const ScheduleDraw& draw,
                                                                  int block, int restarts_before,
                                                                  int first_trial) const;

  /// The order of a participant whose answers decide what comes next. The schedule then has a place
  /// for each presentation, and the order fills them one by one; blocks cannot be restarted.
  /// \return null: the schedule says all
  [[nodiscard]] virtual std::unique_ptr<AdaptiveOrder> adaptive_order(
      const Study& /*study*/, const ScheduleDraw& /*draw*/) const {
    return nullptr;
  }

  /// The stimulus that a choice of the adaptive order was about, for tables and exports.
  [[nodiscard]] virtual StimulusIndex stimulus_of(const Study& /*study*/,
                                                  const ChosenLevel& /*chosen*/) const {
    return {};
  }

  /// The alternatives that a participant chooses between, at least two. An answer is an index into
  /// them.
  [[nodiscard]] virtual std::vector<Choice> choices(const Study& study) const = 0;
  /// The index of the right choice for a scored presentation; empty if no choice is right.
  [[nodiscard]] virtual std::optional<int> right_choice(const Study& study,
                                                        const Presentation& shown) const = 0;

  /// Whether a session's end may say in clear that nearly all answers came from one key. Not where
  /// a key means something by itself, as "same" does, and not where people who feel nothing keep to
  /// one key, as between intervals: there it is the outcome.
  [[nodiscard]] virtual bool may_name_one_key(const Study& /*study*/) const { return false; }

  /// The page of the instructions that tells participants what to do, in English. Needed only by a
  /// protocol for which the files in config/texts have no page of its name; otherwise empty.
  [[nodiscard]] virtual std::string instruction() const { return {}; }
  /// The minimum numbers of methods and classes in a study of this protocol.
  [[nodiscard]] virtual int least_methods() const noexcept { return 1; }
  [[nodiscard]] virtual int least_classes() const noexcept { return 2; }

  /// Adds to a study what follows from the protocol's section, such as a method for each level.
  /// Called before `check`.
  /// \throws StudyError with the place of what makes that impossible
  virtual void complete(const JsonValue& /*file*/, Study& /*study*/) const {}

  /// How trials of several intervals go. The schedule's presentations, or those of the adaptive
  /// order, then have intervals.
  /// \return nothing: a trial presents one plane
  [[nodiscard]] virtual std::optional<IntervalPlan> interval_plan(const Study& /*study*/) const {
    return std::nullopt;
  }
  /// What its intervals mix, of two stimuli: every pair and share.
  [[nodiscard]] virtual std::vector<Interval> mixtures(const Study& /*study*/) const { return {}; }
  /// The presentations of a practice round of such trials, each with its target; empty: no
  /// practice.
  /// \param round  from 1
  [[nodiscard]] virtual std::vector<Presentation> practice_trials(const Study& /*study*/,
                                                                  const ScheduleDraw& /*draw*/,
                                                                  int /*round*/) const {
    return {};
  }
};

/// Registers a protocol under its name. Call before the first study is read. Not thread-safe.
/// \param protocol  must outlive the program's use of studies
/// \throws std::invalid_argument if the name is taken
void add_protocol(const Protocol& protocol);

/// \return the protocol of this name, or null if there is none
[[nodiscard]] const Protocol* find_protocol(std::string_view name);

/// All registered protocols, in the order in which they were added.
[[nodiscard]] const std::vector<const Protocol*>& protocols();

/// Whether the choices of a study are its classes in the same order, as a confusion matrix
/// requires.
[[nodiscard]] bool chooses_classes(const Study& study);
/// Requires that the choices of a study are its classes.
/// \param command  the command that requires it, for the message
/// \throws StudyError if chooses_classes is false
void require_choice_of_classes(const Study& study, const std::string& command);

}  // namespace touchtrial::study
