/// \file The parts of a study besides its trials: the study file's "practice", "session", "visits",
/// "groups" and "registration". Format: docs/study-file.md.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <ratio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::study {

/// A class of textures; each image is an exemplar.
struct StudyClass {
  std::string label;
  std::vector<std::filesystem::path> images;  ///< as written in the file

  friend bool operator==(const StudyClass&, const StudyClass&) = default;
};

/// A text by language code ("en", "de").
using Translated = std::map<std::string, std::string>;

/// Texts by section ("screens") and key ("next"), as in a language file.
using Texts = std::map<std::string, std::map<std::string, std::string>>;

/// What participants can see.
enum class Sight {
  curtain,    ///< the pictures, but neither hand nor device
  blindfold,  ///< nothing: they memorise labels, and the experimenter enters their spoken answers
};

enum class QuestionKind { choice, number, text };

/// A question to the participant.
struct Question {
  std::string id;  ///< a plain name, unique in its questionnaire
  QuestionKind kind = QuestionKind::text;
  Translated text;
  std::vector<Translated> options;  ///< answers of a choice, >= 2
  bool required = false;
  std::optional<double> min{};  ///< bounds of a number
  std::optional<double> max{};

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
  int rounds = 2;  ///< maximum; participants who do not reach the criterion are flagged

  friend bool operator==(const PracticePlan&, const PracticePlan&) = default;
};

/// Noise that masks the device's sound.
struct MaskingPlan {
  bool wanted = true;
  double level_dbfs = -30.0;  ///< rms re full scale, <= 0; the lab measures the level in dBA

  friend bool operator==(const MaskingPlan&, const MaskingPlan&) = default;
};

/// The maximum text scale at which every screen still fits.
inline constexpr double kMaxTextScale = 1.5;

/// The study file's "session".
struct SessionPlan {
  std::string language = "en";  ///< of the participant's texts; one of language_codes()
  /// Pages of instructions by language; empty: the built-in ones.
  std::map<std::string, std::vector<std::string>> instructions;
  std::map<std::string, Texts> texts;  ///< by language; these replace built-in texts
  double text_scale = 1.0;             ///< of the participant's screens, 1 to kMaxTextScale
  bool high_contrast = false;          ///< whether these screens are black on white
  Sight sight = Sight::curtain;
  MaskingPlan masking;
  bool handedness = true;              ///< whether to ask the handedness inventory
  int confidence_levels = 0;           ///< 2 to 9; 0: confidence is not asked
  std::vector<std::string> day_sheet;  ///< items in addition to the built-in ones
  std::string consent_version;         ///< version of the form that participants sign; may be empty
  std::string ethics_number;           ///< may be empty
  std::vector<Question> closing_questions;  ///< in addition to the built-in ones
  bool closing = true;                      ///< whether to ask the built-in closing questions

  friend bool operator==(const SessionPlan&, const SessionPlan&) = default;
};

/// The methods that each visit presents.
enum class VisitMethods {
  all,     ///< every method, in the participant's order
  divided  ///< an equal share of the methods, in that order
};

/// The study file's "visits". Days are periods of 24 hours between the starts of two visits'
/// sessions.
struct VisitPlan {
  int count = 1;
  double min_days = 0.0;             ///< minimum between visits; an earlier visit is refused
  std::optional<double> max_days{};  ///< maximum between visits; a later visit is a deviation
  VisitMethods methods = VisitMethods::all;

  friend bool operator==(const VisitPlan&, const VisitPlan&) = default;
};

/// Time from the start of one visit to the start of the next; negative if the clock was set back.
[[nodiscard]] inline double days_between(std::chrono::nanoseconds first,
                                         std::chrono::nanoseconds next) noexcept {
  return std::chrono::duration<double, std::ratio<86'400>>(next - first).count();
}

/// The study file's "groups", to which participants are assigned at random in equal numbers.
struct GroupPlan {
  std::vector<std::string> labels;  ///< >= 2, unique; empty: the study has no groups
  bool open = false;                ///< whether the experimenter may know the assignment

  friend bool operator==(const GroupPlan&, const GroupPlan&) = default;
};

/// The visits that enter a registered analysis.
enum class RegisteredVisits { all, first, last };

/// The quantity that a registered analysis estimates.
enum class Estimand {
  mean_accuracy,  ///< mean over participants of the share of right answers, against chance
  difference,  ///< mean over participants of the accuracy with one method minus that with another
  mean_threshold,  ///< mean over participants of the threshold at one standard, without a test
  threshold_difference,  ///< mean threshold at one standard minus that at another, against 0
  threshold_equality,    ///< whether all differences between standards are within a margin
};

/// Whether the estimand is in dB, the unit of thresholds; otherwise it is a share of right answers.
[[nodiscard]] constexpr bool is_threshold_estimand(Estimand estimand) noexcept {
  return estimand != Estimand::mean_accuracy && estimand != Estimand::difference;
}

enum class RegisteredTest {
  t,          ///< Student's t test over participants
  sign_flip,  ///< exact flips of the signs of participants' differences
  crossover,  ///< period-adjusted t test of two methods, one after the other
};

/// How the error rate is spent over registered looks (Lan, DeMets 1983).
enum class Spending { obrien_fleming, pocock };

/// "mean-accuracy", "difference", "mean-threshold", "threshold-difference" or "threshold-equality"
[[nodiscard]] std::string_view name_of(Estimand estimand);
/// "t", "sign-flip" or "crossover"
[[nodiscard]] std::string_view name_of(RegisteredTest test);
/// "obrien-fleming" or "pocock"
[[nodiscard]] std::string_view name_of(Spending spending);

/// The registered reasons for excluding a session, in addition to an early stop or the
/// participant's withdrawal.
struct ExclusionRules {
  std::vector<std::string> deviations{};   ///< codes, built-in ones first, that exclude a session
  std::optional<double> invalid_trials{};  ///< maximum share of invalid trials of a session
  /// Maximum number of missed catch trials in a session.
  std::optional<int> missed_catch{};

  friend bool operator==(const ExclusionRules&, const ExclusionRules&) = default;
};

/// A standard of a threshold study. A label or value that is unique in the study may be omitted.
struct RegisteredStandard {
  std::string label;  ///< of a class; may be empty
  std::optional<double> value{};

  friend bool operator==(const RegisteredStandard&, const RegisteredStandard&) = default;
};

/// The part of a registration that the program checks and analyses.
struct RegisteredAnalysis {
  Estimand estimand = Estimand::mean_accuracy;
  /// Labels of methods; the difference is the first minus the second. Empty: the study's two
  /// methods.
  std::vector<std::string> methods{};
  /// Standards, for thresholds; a difference is the first minus the second. Empty: all standards of
  /// the study.
  std::vector<RegisteredStandard> standards{};
  RegisteredTest test = RegisteredTest::t;
  bool one_sided = true;  ///< whether only larger values count against the null hypothesis
  double alpha = 0.05;    ///< 1e-6 .. 0.5
  /// The smallest effect of interest: an accuracy, a difference of accuracies, or a difference of
  /// thresholds in dB.
  std::optional<double> smallest_effect{};
  /// The allowed difference. Non-inferiority: how much worse the first method may be, in (0, 1].
  /// threshold_equality: between two thresholds, dB.
  std::optional<double> margin{};
  std::vector<int> looks{};  ///< numbers of participants at interim looks, ascending
  Spending spending = Spending::obrien_fleming;
  std::optional<ExclusionRules> exclusion_rules{};
  RegisteredVisits visits = RegisteredVisits::all;

  friend bool operator==(const RegisteredAnalysis&, const RegisteredAnalysis&) = default;
};

/// The study file's "registration", which is deposited before the first participant.
struct Registration {
  std::string hypothesis;
  int participants = 0;  ///< 0: not stated
  std::string stopping_rule;
  std::string exclusions;
  std::string primary_test;
  /// Years after the session for which the safety record of an erased participant is kept: stops,
  /// faults, maximum forces, reasons and deviations.
  int safety_record_years = 10;
  std::optional<RegisteredAnalysis> analysis{};

  friend bool operator==(const Registration&, const Registration&) = default;
};

/// The registered analysis as pairs of name and value in words; empty if nothing is registered.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> fields_of(
    const Registration& registration);

}  // namespace touchtrial::study
