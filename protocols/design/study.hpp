/// \file The study file: what is presented, how it is rendered, in which trials.
/// Format: docs/study-file.md and config/schema/study.schema.json.
#pragma once

#include "engine/extraction.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial {

enum class Protocol { classification, comparison };
[[nodiscard]] std::string_view name_of(Protocol protocol);

/// A texture label and its images; each image is an exemplar.
struct StudyClass {
  std::string label;
  std::vector<std::filesystem::path> images;  ///< as written in the file
};

/// A way of taking textures, and what tables and files call it.
struct StudyMethod : ExtractionOptions {
  std::string label;  ///< unique in the study

  friend bool operator==(const StudyMethod&, const StudyMethod&) = default;
};

/// The label of a method that is given none: its name, and its control's if it has one.
[[nodiscard]] std::string default_label(const ExtractionOptions& method);

enum class TrialOrder { shuffled, de_bruijn, uniform };
enum class OnTimeout { fade, no_response };
enum class Blocks { by_method, mixed };

/// The study file's "trials" object.
struct TrialOptions {
  int repeats = 5;  ///< presentations of each class (and method) a participant, >= 1
  TrialOrder order = TrialOrder::shuffled;
  double explore_limit_s = 60.0;  ///< > 0
  OnTimeout on_timeout = OnTimeout::fade;
  int practice = 0;
  int break_every = 0;  ///< trials between breaks; 0: none
  int catch_trials = 0;
  int lead_in = 0;  ///< unscored presentations at the start of each block
  Blocks blocks = Blocks::by_method;

  friend bool operator==(const TrialOptions&, const TrialOptions&) = default;
};

/// A study as read from its file.
struct Study {
  std::string name;
  Protocol protocol = Protocol::classification;
  std::vector<StudyClass> classes;   ///< >= 2, labels unique
  std::vector<StudyMethod> methods;  ///< >= 1, labels unique
  RenderingOptions rendering;
  TrialOptions trials;
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< that image paths are relative to
  std::string source;            ///< the file's name, for errors
  std::string text;              ///< the file's content

  /// The methods that the protocol presents: the first alone for classification, all for
  /// comparison.
  [[nodiscard]] int presented_methods() const noexcept;
  /// Scored presentations a participant.
  [[nodiscard]] int scored_trials() const noexcept;
};

/// Reads a study file strictly: unknown keys, wrong types and impossible values are refused.
/// \throws StudyError with the file, the JSON pointer, and the nearest known key or value
[[nodiscard]] Study load_study(const std::filesystem::path& path);

/// The same from text. \param source  names the origin in errors
[[nodiscard]] Study parse_study(std::string_view text, const std::filesystem::path& folder,
                                const std::string& source);

}  // namespace touchtrial
