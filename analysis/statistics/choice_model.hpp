/// \file The similarity choice model: what looks alike, and what is preferred whatever is felt.
/// P(answer j | class i) = bias_j similarity_ij / sum_k bias_k similarity_ik, similarity symmetric
/// with 1 on its diagonal. Source: docs/statistics.md, "Choice model"; Luce 1963; Townsend, Landon
/// 1982; why zeros matter: docs/decisions/0037.
#pragma once

#include "analysis/statistics/confusion.hpp"
#include "core/plane.hpp"

#include <optional>
#include <vector>

namespace touchtrial::analysis {

/// Zeros leave some parameters without a value; those are NaN, the counts expected exist always.
/// Classes between which answers go both ways, directly or by others, form a group: only within it
/// can biases be compared.
struct ChoiceModel {
  /// K x K, 0 .. : 0 of classes never taken for each other. NaN where one of the two was never
  /// answered right, and where only the one was taken for the other across groups.
  Plane<double> similarity;
  std::vector<double> bias;    ///< of each answer, sums to 1 in a group; NaN if never right
  std::vector<int> group;      ///< of each class, from 0 in order of its first class
  int groups = 1;              ///< 1: all biases can be compared
  Plane<double> expected;      ///< K x K: counts that the model expects
  double g_squared = 0.0;      ///< likelihood ratio against the saturated model
  int degrees_of_freedom = 0;  ///< (K - 1)(K - 2) / 2, fewer where zeros leave nothing to fit
  std::optional<double> p;     ///< of g_squared under chi-square; nothing at 0 degrees
  bool converged = false;      ///< bias settled to 1e-12
};

/// Maximum likelihood over trials with a response, by iterative scaling of the quasi-symmetric
/// table; where the maximum lies at infinity, of what exists of it.
/// \return nothing if a class was never presented with a response, or never answered
[[nodiscard]] std::optional<ChoiceModel> choice_model(const ConfusionMatrix& confusion);

}  // namespace touchtrial::analysis
