/// \file How well people know when they are right. Source: docs/statistics.md, "Confidence";
/// Fleming, Lau 2014.
#pragma once

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// One answer, and how sure its participant was of it.
struct RatedAnswer {
  int rating = 0;  ///< higher: surer
  bool correct = false;
};

/// The area under one participant's type-2 ROC curve: the probability that a right answer was rated
/// higher than a wrong one, equal ratings counting half. 0.5: ratings tell nothing.
/// \return nothing without a right and a wrong answer
[[nodiscard]] std::optional<double> type_2_area(std::span<const RatedAnswer> answers);

}  // namespace touchtrial::analysis
