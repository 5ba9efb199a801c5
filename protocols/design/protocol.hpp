/// \file What a protocol decides of a study: its part of the study file, what is presented, and
/// what counts as an answer. The runner, the store, the window and the exports know a protocol by
/// this interface alone. How to write one: docs/add-a-protocol.md.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/design/schedule.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::design {

struct Study;

/// One of the things between which a participant chooses.
struct Choice {
  std::string label;
  std::optional<int> class_index{};  ///< the class whose picture is shown; none: the label alone
};

/// What a protocol keeps of its own section of the study file. Immutable once read.
class ProtocolOptions {
 public:
  virtual ~ProtocolOptions() = default;
};

/// Stateless and thread-safe: every function depends on its arguments alone.
class Protocol {
 public:
  virtual ~Protocol() = default;

  /// The word of the study file's "protocol".
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;

  /// The name of the protocol's own object in the study file; empty: it has none.
  [[nodiscard]] virtual std::string_view section() const noexcept { return {}; }
  /// Reads that object, or makes its defaults where the file leaves it out.
  /// \throws StudyError with the place of what is not accepted
  [[nodiscard]] virtual std::shared_ptr<const ProtocolOptions> read(
      const std::optional<JsonValue>& section) const;
  /// What a database says of the options in clear: compact JSON that tells nothing of a stimulus;
  /// the seal commits to it. Empty: nothing.
  [[nodiscard]] virtual std::string options_in_clear(const Study& study) const;
  /// Checks a study that has been read otherwise.
  /// \param file  the whole study file, for the place of what is wrong
  /// \throws StudyError with that place and the remedy
  virtual void check(const JsonValue& file, const Study& study) const = 0;

  /// Whether each participant meets all of the study's methods, or the first alone.
  [[nodiscard]] virtual bool presents_all_methods() const noexcept { return true; }
  /// How many of a participant's presentations are scored.
  [[nodiscard]] virtual int scored_trials(const Study& study) const = 0;

  /// Functions behind those of protocols/design/schedule.hpp; arguments, results and errors are
  /// theirs.
  [[nodiscard]] virtual Schedule schedule(const Study& study, int enrolment) const = 0;
  [[nodiscard]] virtual std::string rule(const Study& study) const = 0;
  /// By default the block's presentations shuffled anew.
  [[nodiscard]] virtual std::vector<Presentation> restarted_block(const Study& study, int enrolment,
                                                                  int block, int restarts_before,
                                                                  int first_trial) const;

  /// What a participant chooses between, at least two; an answer is an index into these.
  [[nodiscard]] virtual std::vector<Choice> choices(const Study& study) const = 0;
  /// The choice that is right for a scored presentation; nothing where none is.
  [[nodiscard]] virtual std::optional<int> right_choice(const Study& study,
                                                        const Presentation& shown) const = 0;

  /// The page of the instructions that tells participants what to do, in English: for a protocol
  /// whose name is no page of the files in config/texts. Empty: it is one.
  [[nodiscard]] virtual std::string instruction() const { return {}; }
  /// How many methods a study of this protocol must have at least.
  [[nodiscard]] virtual int least_methods() const noexcept { return 1; }
};

/// Makes a protocol known by its name. Call before the first study is read; not thread-safe.
/// \param protocol  outlives the program's use of studies
/// \throws std::invalid_argument if the name is taken
void add_protocol(const Protocol& protocol);

/// \return null if no protocol has the name
[[nodiscard]] const Protocol* find_protocol(std::string_view name);

/// All known protocols, in the order in which they were added.
[[nodiscard]] const std::vector<const Protocol*>& protocols();

/// Whether the choices of a study are its classes, in their order: what a confusion matrix needs.
[[nodiscard]] bool chooses_classes(const Study& study);
/// \param command  that needs it, for the message
/// \throws StudyError if chooses_classes is false
void require_choice_of_classes(const Study& study, const std::string& command);

}  // namespace touchtrial::design
