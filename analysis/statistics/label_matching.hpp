/// \file Whether somebody who answers wrongly tells classes apart all the same: the accuracy that
/// the best exchange of labels would give. Source: docs/statistics.md, "Swapped labels".
#pragma once

#include "analysis/statistics/confusion.hpp"
#include "analysis/statistics/proportion.hpp"

#include <vector>

namespace touchtrial::analysis {

/// The one-to-one matching of classes and answers with the most trials.
struct LabelMatching {
  Proportion accuracy;         ///< trials with the matched answer, of all
  std::vector<int> answer_of;  ///< of each presented class; the identity wherever it ties
};

/// Assignment in O(K^3). Biased upward by the choice: with few trials the best matching is above
/// chance even for answers at random.
[[nodiscard]] LabelMatching best_label_matching(const ConfusionMatrix& confusion);

}  // namespace touchtrial::analysis
