/// \file The similarity choice model: how similar classes feel, and how strongly each answer is
/// preferred regardless of what is felt. P(answer j | class i) = bias_j similarity_ij / sum_k
/// bias_k similarity_ik; similarity is symmetric with 1 on its diagonal. Sources:
/// docs/statistics.md, "Choice model"; Luce 1963; Townsend, Landon 1982; on zero counts,
/// docs/decisions/README.md, decision 37.
#pragma once

#include "analysis/statistics/confusion.hpp"
#include "core/plane.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace touchtrial::analysis {

/// Zero counts leave some parameters undefined (NaN); the expected counts always exist. Classes
/// that wrong answers connect in both directions, directly or through other classes, form a group.
/// Biases can be compared only within a group.
struct ChoiceModel {
  /// K x K, >= 0; 0 for classes that were never confused. NaN if either class was never answered
  /// right, or if classes of different groups were confused in one direction only.
  Plane<double> similarity;
  std::vector<double> bias;         ///< by answer, sums to 1 in a group; NaN if never right
  std::vector<int> group;           ///< by class, numbered from 0 in the order of first classes
  int groups = 1;                   ///< number of groups
  Plane<double> expected;           ///< K x K: the counts that the model expects
  double g_squared = 0.0;           ///< likelihood ratio against the saturated model
  int degrees_of_freedom = 0;       ///< (K - 1)(K - 2) / 2, fewer with zero counts
  std::optional<double> p;          ///< of g_squared under chi-square; nothing at 0 degrees
  int draws = 0;                    ///< tables drawn for drawn_p
  std::optional<double> drawn_p{};  ///< choice_model_p, if it was computed
  bool converged = false;           ///< the biases changed by less than 1e-12 in the last step
};

/// Maximum likelihood over trials with a response, by iterative scaling of the quasi-symmetric
/// table. Parameters whose maximum lies at infinity are not estimated.
/// \return nothing if a class was never presented with a response, or never answered
[[nodiscard]] std::optional<ChoiceModel> choice_model(const ConfusionMatrix& confusion);

/// The p of g_squared by a parametric bootstrap, which unlike chi-square needs no large counts. It
/// is the share of tables drawn from the fitted model that fit at least as badly, (b + 1) / (m +
/// 1). Drawn tables have the observed number of answers to each class.
/// \param draws  m, >= 1; each one draws all trials once
/// \param index  chooses the stream of random numbers
/// \return nothing at 0 degrees of freedom
/// \throws std::invalid_argument if draws < 1
[[nodiscard]] std::optional<double> choice_model_p(const ChoiceModel& model, int draws,
                                                   std::uint64_t index = 0);

}  // namespace touchtrial::analysis
