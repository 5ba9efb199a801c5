/// \file What a session consists of beside its trials: the study file's "practice", "session" and
/// "registration". Format: docs/study-file.md.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::design {

/// Each image is an exemplar.
struct StudyClass {
  std::string label;
  std::vector<std::filesystem::path> images;  ///< as written in the file

  friend bool operator==(const StudyClass&, const StudyClass&) = default;
};

/// A text in several languages, by their codes ("en", "de").
using Translated = std::map<std::string, std::string>;

/// What participants see of pictures and hand.
enum class Sight {
  curtain,    ///< hand and device hidden; pictures visible
  blindfold,  ///< nothing; labels learnt by heart, answers spoken and entered by the experimenter
};

enum class QuestionKind { choice, number, text };

/// A question to the participant.
struct Question {
  std::string id;  ///< a plain name, unique in its questionnaire
  QuestionKind kind = QuestionKind::text;
  Translated text;
  std::vector<Translated> options;  ///< of a choice, >= 2
  bool required = false;

  friend bool operator==(const Question&, const Question&) = default;
};

/// Questions that are asked together.
struct Questionnaire {
  std::string name;  ///< plain; for instance "handedness", "closing"
  std::vector<Question> questions;
};

/// Textures to learn the task on; none is in the study.
struct PracticePlan {
  std::vector<StudyClass> classes;  ///< one image each
  int criterion = 4;                ///< correct answers that end practice, <= trials.practice
  int rounds = 2;                   ///< at most; who does not reach the criterion is flagged

  friend bool operator==(const PracticePlan&, const PracticePlan&) = default;
};

/// Noise that covers the device's sound.
struct MaskingPlan {
  bool wanted = true;
  double level_dbfs = -30.0;  ///< rms, below full scale, <= 0; what it is in dBA the lab measures

  friend bool operator==(const MaskingPlan&, const MaskingPlan&) = default;
};

/// The study file's "session".
struct SessionPlan {
  std::string language = "en";  ///< of what the participant reads: "en" or "de"
  /// Pages of instruction by language; empty: the program's own.
  std::map<std::string, std::vector<std::string>> instructions;
  Sight sight = Sight::curtain;
  MaskingPlan masking;
  bool handedness = true;                   ///< ask the inventory
  int confidence_levels = 0;                ///< 0: not asked; else 2 to 9
  std::vector<std::string> day_sheet;       ///< items beside the program's own
  std::string consent_version;              ///< that participants sign; may be empty
  std::string ethics_number;                ///< may be empty
  std::vector<Question> closing_questions;  ///< beside the program's own
  bool closing = true;                      ///< ask the program's own closing questions

  friend bool operator==(const SessionPlan&, const SessionPlan&) = default;
};

/// The study file's "registration": what is deposited before the first participant.
struct Registration {
  std::string hypothesis;
  int participants = 0;  ///< 0: not stated
  std::string stopping_rule;
  std::string exclusions;
  std::string primary_test;

  friend bool operator==(const Registration&, const Registration&) = default;
};

}  // namespace touchtrial::design
