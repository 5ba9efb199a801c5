/// \file The study file: what is presented, how it is rendered, in which trials.
/// Format: docs/study-file.md and config/schema/study.schema.json.
#pragma once

#include "engine/extraction.hpp"
#include "engine/rendering/rendering_options.hpp"
#include "protocols/design/session_plan.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::design {

class Protocol;
class ProtocolOptions;

/// A way of taking textures, and what tables and files call it.
struct StudyMethod : engine::ExtractionOptions {
  std::string label;  ///< unique in the study

  friend bool operator==(const StudyMethod&, const StudyMethod&) = default;
};

/// The label of a method that is given none: its name, and its control's if it has one.
[[nodiscard]] std::string default_label(const engine::ExtractionOptions& method);

enum class TrialOrder { shuffled, de_bruijn, uniform, williams };
[[nodiscard]] std::string_view name_of(TrialOrder order);
enum class OnTimeout { fade, no_response };
enum class Blocks { by_method, mixed };
[[nodiscard]] std::string_view name_of(Blocks blocks);
/// The study file's word for a rendering model.
[[nodiscard]] std::string_view name_of(engine::ModelKind model);
/// What becomes of a presentation that was spoilt: by a fault, a comfort stop, or the program's
/// end.
enum class OnInterruption { repeat, leave_out, restart_block };

/// The study file's "trials" object.
struct TrialOptions {
  int repeats = 5;  ///< presentations of each class (and method) a participant, >= 1
  TrialOrder order = TrialOrder::shuffled;
  double explore_limit_s = 60.0;  ///< > 0
  OnTimeout on_timeout = OnTimeout::fade;
  int practice = 0;      ///< presentations of a practice round
  int break_every = 0;   ///< trials between breaks; 0: none
  int catch_trials = 0;  ///< unscored presentations of a plane without texture, among the others
  int lead_in = 0;       ///< unscored presentations at the start of each block
  Blocks blocks = Blocks::by_method;
  int max_run = 0;  ///< presentations of one class in a row, at most; 0: any number
  OnInterruption on_interruption = OnInterruption::repeat;
  double resume_within_h =
      24.0;  ///< a session that was broken off can be taken up for so long, > 0

  friend bool operator==(const TrialOptions&, const TrialOptions&) = default;
};

/// A study as read from its file.
struct Study {
  std::string name;
  const Protocol* protocol = nullptr;              ///< never null in a study that was read
  std::shared_ptr<const ProtocolOptions> options;  ///< of the protocol's own section; may be null
  std::vector<StudyClass> classes;                 ///< >= 2, labels unique
  std::vector<StudyMethod> methods;                ///< >= 1, labels unique
  engine::RenderingOptions rendering;
  TrialOptions trials;
  PracticePlan practice;
  SessionPlan session;
  Registration registration;
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< that image paths are relative to
  std::string source;            ///< the file's name, for errors
  std::string text;              ///< the file's content

  /// The protocol's name, as the file has it.
  [[nodiscard]] std::string protocol_name() const;
  /// How many methods are presented, from the first on.
  [[nodiscard]] int presented_methods() const;
  /// Scored presentations of one participant.
  [[nodiscard]] int scored_trials() const;
};

/// Reads a study file strictly: unknown keys, wrong types and impossible values are refused.
/// \throws StudyError with the file, the JSON pointer, and the nearest known key or value
[[nodiscard]] Study load_study(const std::filesystem::path& path);

/// The same from text. \param source  names the origin in errors
[[nodiscard]] Study parse_study(std::string_view text, const std::filesystem::path& folder,
                                const std::string& source);

}  // namespace touchtrial::design
