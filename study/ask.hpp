/// \file A trial as the participant experiences it: how planes are explored, and what is asked
/// afterwards. Nothing here reveals what is presented: windows and participants include this file,
/// but not study/schedule.hpp. Source: docs/add-a-protocol.md.
#pragma once

#include "core/answer.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace touchtrial::study {

/// The position of a trial in a session. It may be stored unencrypted, because it depends only on
/// the participant's secret and the number of earlier trials, never on an answer.
struct Place {
  int trial = 0;          ///< from 1
  int block = 0;          ///< from 0
  bool hand_off = false;  ///< the device moves by itself; the participant only hears it

  friend bool operator==(const Place&, const Place&) = default;
};

/// The speed and force of the hand within which a plane's clock runs. The force is that of the wall
/// without its texture, so that the clock reveals nothing about the texture.
struct HandRange {
  double slowest_mm_s = 20.0;  ///< along the plane
  double fastest_mm_s = 300.0;
  double lightest_n = 0.15;
  double strongest_n = 2.5;

  friend bool operator==(const HandRange&, const HandRange&) = default;
};

/// Height above the plane at which the stylus counts as lifted, mm.
inline constexpr double kLiftedMm = 1.0;

/// Time in which a plane's force fades to zero when its exploration ends.
inline constexpr std::chrono::milliseconds kFade{100};

/// Exploration without a fixed time, up to the study's explore_limit_s. If the trial has one plane,
/// the participant may feel it again before answering.
struct FreeExploration {};

/// Exploration for a fixed time, counted only in contact and within the range, after which the hand
/// lifts off. A trial is repeated if a clock has not run down within the study's explore_limit_s.
/// Source: docs/thresholds.md, "Intervals".
struct TimedContact {
  double seconds = 2.5;  ///< > 0
  HandRange range{};
};

/// A circular stroke in the plane, whose lateral forces the device plays while the hand is off it.
struct PlayedStroke {
  double seconds = 2.5;  ///< > 0
};

// The speed of that stroke, which the instructions request, and its load.
inline constexpr double kPlayedMmS = 100.0;
inline constexpr double kPlayedLoadN = 0.7;

using ExplorationMode = std::variant<FreeExploration, TimedContact, PlayedStroke>;

/// One of the alternatives that a participant chooses between.
struct Choice {
  std::string label;
  std::optional<int> class_index{};  ///< the class whose picture is shown; empty: only the label
};

/// Asks for one of two or more alternatives.
struct ChoiceQuestion {
  /// Key of the title in the texts' "screens", or the title itself; empty: "which picture is it?".
  std::string title{};
  std::vector<Choice> choices;

  /// Whether the alternatives are words, and not pictures.
  [[nodiscard]] bool has_words() const noexcept {
    return !title.empty() || (!choices.empty() && !choices.front().class_index);
  }
};

/// A rating scale with two labelled ends, in the participant's language.
struct Scale {
  std::string id;    ///< a plain name, unique in its question
  std::string text;  ///< what is rated
  std::string low;   ///< labels of the two ends
  std::string high;
  int points = 0;  ///< 0: a line from 0 to 1; otherwise numbers from 1 to this number

  [[nodiscard]] double min() const noexcept { return points == 0 ? 0.0 : 1.0; }
  [[nodiscard]] double max() const noexcept { return points == 0 ? 1.0 : points; }

  friend bool operator==(const Scale&, const Scale&) = default;
};

/// Answers on a line are rounded to this step, so that the length of a sealed answer reveals
/// nothing.
inline constexpr double kLineStep = 0.001;

/// Asks for a rating on each of one or more scales.
struct RatingQuestion {
  std::string title{};  ///< key of the title in the texts' "screens", or the title itself
  std::vector<Scale> scales;
};

using QuestionForm = std::variant<ChoiceQuestion, RatingQuestion>;

/// What a participant does and answers in one trial.
struct TrialQuestion {
  ExplorationMode exploring{};
  int planes = 1;  ///< presented one after the other
  QuestionForm question{};
  int confidence_levels = 0;  ///< 0: not asked
  bool feedback = false;      ///< whether each answer is followed by "right" or "wrong"

  /// The alternatives; empty for a question with scales.
  [[nodiscard]] std::vector<Choice> choices() const {
    const auto* const choice = std::get_if<ChoiceQuestion>(&question);
    return choice == nullptr ? std::vector<Choice>() : choice->choices;
  }
  /// The scales; empty for a question with alternatives.
  [[nodiscard]] std::vector<Scale> scales() const {
    const auto* const rating = std::get_if<RatingQuestion>(&question);
    return rating == nullptr ? std::vector<Scale>() : rating->scales;
  }
  /// Whether the alternatives are pictures, whose positions are randomised for each participant.
  [[nodiscard]] bool has_pictures() const noexcept {
    const auto* const choice = std::get_if<ChoiceQuestion>(&question);
    return choice != nullptr && !choice->choices.empty() &&
           choice->choices.front().class_index.has_value();
  }
  /// Key of the question's title; empty: "which picture is it?".
  [[nodiscard]] const std::string& title() const noexcept {
    return std::visit([](const auto& form) -> const std::string& { return form.title; }, question);
  }
};

/// Explains why an answer does not fit its question, for example "has 1 ratings for 2 scales".
/// \return empty if it fits
[[nodiscard]] std::string mismatch_of(const Answer& answer, const TrialQuestion& question);

}  // namespace touchtrial::study
