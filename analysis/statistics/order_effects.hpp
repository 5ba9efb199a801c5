/// \file Tests of whether answers depend on the time of a presentation or on the previous
/// presentation. They are randomisation tests over the order: if each answer depends only on its
/// own presentation, both can move together to any other place that the design allows. Sources:
/// docs/statistics.md, "Order"; Fischer, Whitney 2014; Phipson, Smyth 2010.
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
  /// The design could have put it at another place in the block. False for lead-ins, trials that
  /// do not count and trials of another method.
  bool moves = true;
  double place = 0.0;  ///< if it moves: its number among the participant's trials
};

/// One participant's presentations within one block, in the order in which they were felt.
using FeltBlock = std::vector<FeltTrial>;

/// Draws the classes of one block's moving trials anew by the study's rule. The result depends only
/// on the block's index, counted over all participants, and on the number of the draw, from 0.
using ClassRedraw = std::function<std::vector<int>(std::size_t block, int draw)>;

/// Wrong answers that repeat the previous stimulus or answer.
struct SerialDependence {
  int wrong = 0;          ///< wrong answers just after a presentation with a class, or an answer
  int same = 0;           ///< wrong answers that name that class or repeat that answer
  double expected = 0.0;  ///< mean of `same` over the drawn orders
  std::optional<double> p{};  ///< two-sided; nothing without a wrong answer
};

struct OrderEffects {
  /// Least-squares slope of right answers (0 or 1) on places, per trial, within blocks; the mean
  /// over participants with at least two places in a block.
  MeanEstimate slope;
  std::optional<double> slope_p{};  ///< two-sided; nothing without a slope
  SerialDependence class_before;    ///< on the previous class
  SerialDependence answer_before;   ///< on the previous answer
  int draws = 0;                    ///< of random orders
};

/// \param participants  the blocks of each participant
/// \param redraw  empty if every order of a block's moving trials was possible. Trials of a class
///   are distributed at random over the places of that class. If a drawn order has a different
///   number of places for a class, the block keeps its order, which can only raise p.
/// \param draws  >= 1; p is 2 (b + 1) / (draws + 1) of the smaller tail; each visits all trials
/// \param index  chooses the stream of random numbers
/// \return nothing without a moving trial
/// \throws std::invalid_argument if draws < 1, a class is negative, or a redrawn order has another
///   length
[[nodiscard]] std::optional<OrderEffects> order_effects(
    std::span<const std::vector<FeltBlock>> participants, const ClassRedraw& redraw, int draws,
    std::uint64_t index = 0);

}  // namespace touchtrial::analysis
