/// \file Whether participants prefer an answer whatever they felt: by person, because people who
/// prefer different answers cancel out in a mean. Sources: docs/statistics.md, "Any participant"
/// and "Preferences".
#pragma once

#include "analysis/choices/answers.hpp"
#include "analysis/statistics/anybody.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::choices {

/// One participant's answers.
struct Preference {
  std::string participant;
  int choice = 0;              ///< the one named most beyond what is expected
  std::optional<int> place{};  ///< of that choice in the last session, from 0; if layouts differ
  int answers = 0;
  int named = 0;               ///< of them, those that name it
  Proportion right_there;      ///< right answers where it was right
  Proportion right_elsewhere;  ///< and where another choice was
  double p = 1.0;              ///< that there is no preference
  double p_holm = 1.0;         ///< over participants
};

struct Preferences {
  std::vector<Preference> people;  ///< with an answer
  Anybody anybody;

  /// Those whose own p is within the level, if anybody prefers a choice.
  [[nodiscard]] std::vector<const Preference*> of_those_who_prefer() const;
};

/// Of studies whose right choice is drawn trial by trial, each choice equally often. Without a
/// preference somebody is right as often whichever choice is right, and each is named equally
/// often: with c the share right of n trials and k right in T of them, S_k = named_k - c T_k - (1 -
/// c) (n - T_k) / (m - 1) has mean 0. Right answers keep their places, which levels may follow, and
/// choices are drawn anew; p is of the sum of squares of S_k.
[[nodiscard]] Preferences preferences_by_target(std::span<const Person> people, int choices,
                                                const Which& which,
                                                int most_deals = analysis::kAnybodyDeals);

/// Of studies with stimuli that resemble each other in unknown ways. Among the wrong answers that
/// take one of two stimuli for the other, which of them was named does not depend on the
/// participant if nobody has preferences of their own; in each deal the names are exchanged between
/// people. A preference that all share for one stimulus is left to confusions; a place that all
/// prefer shows, as each participant has a layout of their own.
/// \param people  with scored trials; those without an answer do not count
[[nodiscard]] Preferences preferences_among_errors(std::span<const Person> people, int choices,
                                                   int most_deals = analysis::kAnybodyDeals);

/// One place on the answer screen.
struct PlaceUse {
  int named = 0;
  GroupTest excess;  ///< share of participants' answers less 1 / places
};

/// Answers by their places in layouts that are drawn at random for each participant.
struct AnswersByPlace {
  std::vector<PlaceUse> places;  ///< in the order of the screen
  double p = 1.0;                ///< that all people together prefer no place: layouts dealt anew
  int deals = 0;                 ///< of layouts
  Preferences own;               ///< preferences_among_errors
};

/// \param people  as above
/// \return nothing without an answer at a place
[[nodiscard]] std::optional<AnswersByPlace> answers_by_place(std::span<const Person> people,
                                                             int choices);

}  // namespace touchtrial::choices
