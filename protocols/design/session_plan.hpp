/// \file The parts of a session besides its trials: the study file's "practice", "session" and
/// "registration". Format: docs/study-file.md.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::design {

/// A class of textures; each image is an exemplar.
struct StudyClass {
  std::string label;
  std::vector<std::filesystem::path> images;  ///< as written in the file

  friend bool operator==(const StudyClass&, const StudyClass&) = default;
};

/// A text in several languages, by their codes ("en", "de").
using Translated = std::map<std::string, std::string>;

/// What participants see of the pictures and of their hand.
enum class Sight {
  curtain,    ///< pictures, but neither hand nor device
  blindfold,  ///< nothing: labels are learnt by heart, and the experimenter enters spoken answers
};

enum class QuestionKind { choice, number, text };

/// A question to the participant.
struct Question {
  std::string id;  ///< a plain name, unique in its questionnaire
  QuestionKind kind = QuestionKind::text;
  Translated text;
  std::vector<Translated> options;  ///< answers of a choice, >= 2
  bool required = false;

  friend bool operator==(const Question&, const Question&) = default;
};

/// Questions that are asked together.
struct Questionnaire {
  std::string name;  ///< a plain name, for instance "handedness" or "closing"
  std::vector<Question> questions;
};

/// Textures for learning the task; none of them is in the study.
struct PracticePlan {
  std::vector<StudyClass> classes;  ///< one image each
  int criterion = 4;                ///< correct answers that end practice, <= trials.practice
  int rounds = 2;  ///< maximum; participants who never reach the criterion are flagged

  friend bool operator==(const PracticePlan&, const PracticePlan&) = default;
};

/// Noise that masks the device's sound.
struct MaskingPlan {
  bool wanted = true;
  double level_dbfs = -30.0;  ///< rms re full scale, <= 0; the lab measures the level in dBA

  friend bool operator==(const MaskingPlan&, const MaskingPlan&) = default;
};

/// The study file's "session".
struct SessionPlan {
  std::string language = "en";  ///< language of the participant's texts: "en" or "de"
  /// Pages of instructions by language; empty: the program's own.
  std::map<std::string, std::vector<std::string>> instructions;
  Sight sight = Sight::curtain;
  MaskingPlan masking;
  bool handedness = true;                   ///< whether to ask the handedness inventory
  int confidence_levels = 0;                ///< 2 to 9; 0: confidence is not asked
  std::vector<std::string> day_sheet;       ///< items in addition to the program's own
  std::string consent_version;              ///< version that participants sign; may be empty
  std::string ethics_number;                ///< may be empty
  std::vector<Question> closing_questions;  ///< in addition to the program's own
  bool closing = true;                      ///< whether to ask the program's own closing questions

  friend bool operator==(const SessionPlan&, const SessionPlan&) = default;
};

/// The study file's "registration", which is deposited before the first participant.
struct Registration {
  std::string hypothesis;
  int participants = 0;  ///< 0: not stated
  std::string stopping_rule;
  std::string exclusions;
  std::string primary_test;
  /// That stops, faults, largest forces, reasons and deviations of somebody whose data were erased
  /// are kept, from the session on.
  int safety_record_years = 10;

  friend bool operator==(const Registration&, const Registration&) = default;
};

}  // namespace touchtrial::design
