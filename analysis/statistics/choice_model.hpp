/// \file The similarity choice model: what looks alike, and what is preferred whatever is felt.
/// P(answer j | class i) = bias_j similarity_ij / sum_k bias_k similarity_ik, similarity symmetric
/// with 1 on its diagonal. Source: docs/statistics.md, "Choice model"; Luce 1963; Townsend, Landon
/// 1982.
#pragma once

#include "analysis/statistics/confusion.hpp"
#include "core/plane.hpp"

#include <optional>
#include <vector>

namespace touchtrial {

struct ChoiceModel {
  Plane<double> similarity;    ///< K x K, 0 .. : 0 of classes never taken for each other
  std::vector<double> bias;    ///< of each answer, sums to 1
  Plane<double> expected;      ///< K x K: counts that the model expects
  double g_squared = 0.0;      ///< likelihood ratio against the saturated model
  int degrees_of_freedom = 0;  ///< (K - 1)(K - 2) / 2
  std::optional<double> p;     ///< of g_squared under chi-square; nothing at 0 degrees
  bool converged = false;
};

/// Maximum likelihood over trials with a response, by iterative scaling of the quasi-symmetric
/// table. Where a class was never answered right its similarities do not exist: they are NaN.
/// \return nothing if a class was never presented with a response, or never answered
[[nodiscard]] std::optional<ChoiceModel> choice_model(const ConfusionMatrix& confusion);

}  // namespace touchtrial
