/// \file Tests of whether answers depend on the time of a presentation or on the presentation
/// before it. These are randomisation tests over the order: if each answer depends only on its own
/// presentation, it moves with that presentation to any other place that the design allows.
/// Sources: docs/statistics.md, "Order"; Fischer, Whitney 2014; Phipson, Smyth 2010.
#pragma once

#include "analysis/statistics/descriptive.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// One presentation, as a participant felt it.
struct FeltTrial {
  std::optional<int> presented;  ///< class; nothing: a catch trial
  std::optional<int> answered;   ///< class; nothing: no response
  bool follows = false;          ///< the previous trial of the block was felt immediately before it
  bool moves = true;   ///< it could have another place in the block; false for a lead-in, a trial
                       ///< that does not count, or one of another method
  double place = 0.0;  ///< of a trial that moves: number among the participant's trials
};

/// One participant's presentations within one block, in the order in which they were felt.
using FeltBlock = std::vector<FeltTrial>;

/// Draws the classes of one block's moving trials anew by the study's rule. The result depends only
/// on the block's index, counted over all participants, and on the number of the draw, from 0.
using RedrawnClasses = std::function<std::vector<int>(std::size_t block, int draw)>;

/// Wrong answers that repeat the previous stimulus or answer.
struct SerialDependence {
  int wrong = 0;          ///< wrong answers just after a presentation with a class, or an answer
  int same = 0;           ///< of these, those that name that class or repeat that answer
  double expected = 0.0;  ///< mean of `same` over the drawn orders
  std::optional<double> p{};  ///< two-sided; nothing without a wrong answer
};

struct OrderEffects {
  /// Least-squares slope of right answers (0 or 1) on places, per trial, within blocks; over
  /// participants with two places or more in a block.
  MeanEstimate slope;
  std::optional<double> slope_p{};  ///< two-sided; nothing without a slope
  SerialDependence class_before;
  SerialDependence answer_before;
  int draws = 0;
};

/// \param participants  their blocks
/// \param redraw  empty if every order of a block's moving trials was possible. Trials of a class
///   are distributed at random over the places of that class. If a drawn order has other numbers of
///   places, the block stays as it was, which can only raise p.
/// \param draws  m of p = 2 (b + 1) / (m + 1) of the smaller tail, >= 1; each draw visits all
///   trials once
/// \param index  chooses the stream of random numbers
/// \return nothing without a moving trial
/// \throws std::invalid_argument if draws < 1, a class is negative, or a redrawn order has another
///   length
[[nodiscard]] std::optional<OrderEffects> order_effects(
    std::span<const std::vector<FeltBlock>> participants, const RedrawnClasses& redraw, int draws,
    std::uint64_t index = 0);

}  // namespace touchtrial::analysis
