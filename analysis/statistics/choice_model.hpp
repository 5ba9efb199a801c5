/// \file The similarity choice model: which classes feel alike, and which answers are preferred
/// whatever is felt.
/// P(answer j | class i) = bias_j similarity_ij / sum_k bias_k similarity_ik, similarity symmetric
/// with 1 on its diagonal. Source: docs/statistics.md, "Choice model"; Luce 1963; Townsend, Landon
/// 1982; why zeros matter: docs/decisions/README.md, decision 37.
#pragma once

#include "analysis/statistics/confusion.hpp"
#include "core/plane.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace touchtrial::analysis {

/// Zeros leave some parameters without a value, which are then NaN; the expected counts always
/// exist. Classes between which wrong answers lead both ways, directly or over others, form a
/// group: biases can be compared only within a group.
struct ChoiceModel {
  /// K x K, >= 0; 0 for classes that were never taken for each other. NaN where one of the two was
  /// never answered right, and where across groups only one was taken for the other.
  Plane<double> similarity;
  std::vector<double> bias;    ///< of each answer, sums to 1 in a group; NaN if never right
  std::vector<int> group;      ///< of each class, numbered from 0 in the order of first classes
  int groups = 1;              ///< with 1, all biases can be compared
  Plane<double> expected;      ///< K x K: the counts that the model expects
  double g_squared = 0.0;      ///< likelihood ratio against the saturated model
  int degrees_of_freedom = 0;  ///< (K - 1)(K - 2) / 2, fewer where zeros leave nothing to fit
  std::optional<double> p;     ///< of g_squared under chi-square; nothing at 0 degrees
  int draws = 0;               ///< of tables for the next number
  std::optional<double> drawn_p{};  ///< choice_model_p, if it was computed
  bool converged = false;           ///< the biases changed by less than 1e-12 in the last step
};

/// Maximum likelihood over trials with a response, by iterative scaling of the quasi-symmetric
/// table. Where the maximum lies at infinity, only the parameters that exist are estimated.
/// \return nothing if a class was never presented with a response, or never answered
[[nodiscard]] std::optional<ChoiceModel> choice_model(const ConfusionMatrix& confusion);

/// The p of g_squared by a parametric bootstrap: the share of tables drawn from the fitted model,
/// with as many answers to each class, whose own fit is as bad; (b + 1) / (m + 1). It needs no
/// large counts, as chi-square does.
/// \param draws  m, >= 1; cost: each draws all trials once
/// \param index  chooses the stream of random numbers
/// \return nothing at 0 degrees of freedom
/// \throws std::invalid_argument if draws < 1
[[nodiscard]] std::optional<double> choice_model_p(const ChoiceModel& model, int draws,
                                                   std::uint64_t index = 0);

}  // namespace touchtrial::analysis
