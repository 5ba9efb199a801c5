/// \file How a trial goes for a participant: how its planes are explored, and what is asked
/// afterwards. Nothing here says what is presented: windows and participants know this file and not
/// study/schedule.hpp. Source: docs/add-a-protocol.md.
#pragma once

#include "core/answer.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace touchtrial::study {

/// Where a trial stands in a session. In clear: it follows from the participant's secret and from
/// the number of earlier trials, never from what was answered.
struct Place {
  int trial = 0;          ///< from 1
  int block = 0;          ///< from 0
  bool hand_off = false;  ///< the device moves by itself, and is only heard

  friend bool operator==(const Place&, const Place&) = default;
};

/// What the hand must do for a plane's clock to run. Speed and force are those of the hand: the
/// force is what the wall without texture would answer, so that the clock tells nothing of the
/// texture.
struct HandRange {
  double slowest_mm_s = 20.0;  ///< along the plane
  double fastest_mm_s = 300.0;
  double lightest_n = 0.15;
  double strongest_n = 2.5;

  friend bool operator==(const HandRange&, const HandRange&) = default;
};

/// A stylus that is so far above the plane has lifted off, mm.
inline constexpr double kLiftedMm = 1.0;

/// For as long as the participant wants, up to the study's explore_limit_s. A plane that is the
/// trial's only one can be felt again before the answer.
struct Free {};

/// For a time that is counted only in contact and inside the range; then the hand lifts off. A
/// trial with a plane whose clock has not run down within the study's explore_limit_s is repeated.
/// Source: docs/thresholds.md, "Intervals".
struct InContact {
  double seconds = 2.5;  ///< > 0
  HandRange range{};
};

/// The device moves by itself, with the hand off.
struct Played {
  double seconds = 2.5;  ///< > 0
};

using Exploring = std::variant<Free, InContact, Played>;

/// One of the alternatives that a participant chooses between.
struct Choice {
  std::string label;
  std::optional<int> class_index{};  ///< the class whose picture is shown; empty: the label alone
};

/// Asks for one of several alternatives, at least two.
struct Choose {
  /// Key of the title in the texts' "screens", or the title itself; empty: which picture it is.
  std::string title{};
  std::vector<Choice> choices;

  /// Whether the alternatives are words, and not pictures.
  [[nodiscard]] bool has_words() const noexcept {
    return !title.empty() || (!choices.empty() && !choices.front().class_index);
  }
};

/// A scale between two ends, in the participant's language.
struct Scale {
  std::string id;    ///< a plain name, unique in its question
  std::string text;  ///< what is rated
  std::string low;   ///< the words at the ends
  std::string high;
  int points = 0;  ///< 0: a line from 0 to 1; else numbers from 1 to this

  [[nodiscard]] double min() const noexcept { return points == 0 ? 0.0 : 1.0; }
  [[nodiscard]] double max() const noexcept { return points == 0 ? 1.0 : points; }

  friend bool operator==(const Scale&, const Scale&) = default;
};

/// A line's answers are multiples of this, so that their sealed lengths say nothing.
inline constexpr double kLineStep = 0.001;

/// Asks for a number on each of one or several scales.
struct Rate {
  std::string title{};  ///< key of the title in the texts' "screens", or the title itself
  std::vector<Scale> scales;
};

using Asked = std::variant<Choose, Rate>;

/// What is asked of a participant in a trial.
struct Ask {
  Exploring exploring{};
  int planes = 1;  ///< presented one after the other
  Asked question{};
  int confidence_levels = 0;  ///< 0: not asked
  bool feedback = false;      ///< after each answer, whether it was right

  /// The alternatives; empty where none are asked for.
  [[nodiscard]] std::vector<Choice> choices() const {
    const auto* const choose = std::get_if<Choose>(&question);
    return choose == nullptr ? std::vector<Choice>() : choose->choices;
  }
  /// Empty where none are asked for.
  [[nodiscard]] std::vector<Scale> scales() const {
    const auto* const rate = std::get_if<Rate>(&question);
    return rate == nullptr ? std::vector<Scale>() : rate->scales;
  }
  /// Whether the alternatives are pictures, whose places are drawn for each participant.
  [[nodiscard]] bool has_pictures() const noexcept {
    const auto* const choose = std::get_if<Choose>(&question);
    return choose != nullptr && !choose->choices.empty() &&
           choose->choices.front().class_index.has_value();
  }
  /// Key of the question's title; empty: which picture it is.
  [[nodiscard]] const std::string& title() const noexcept {
    return std::visit([](const auto& asked) -> const std::string& { return asked.title; },
                      question);
  }
};

/// Why an answer is none to what is asked, in words that follow the trial's name; empty: it is one.
[[nodiscard]] std::string misfit_of(const Answer& answer, const Ask& ask);

}  // namespace touchtrial::study
