/// \file Power of the difference between two methods' ratings, and the width of its interval, by
/// number of participants. Source: docs/planning.md, "Power of rating studies".
#pragma once

#include "analysis/planning/power_curve.hpp"
#include "analysis/statistics/proportion.hpp"
#include "protocols/rating/planning/rating_pool.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::planning::rating {

struct RatingPlan {
  std::vector<int> participants;  ///< sample sizes, each >= 2
  int runs = 1000;                ///< samples per size, >= 1
  std::uint64_t seed = 1;         ///< for drawing samples
  double alpha = 0.05;            ///< of the sign-flip test, two-sided
};

/// Power on one scale, over samples.
struct DifferencePower {
  analysis::Proportion significant;  ///< samples with sign_flip_p <= alpha
  analysis::Interval power{};        ///< Wilson's, 95 %
  /// Significant results for the same samples with random signs of the differences.
  analysis::Proportion false_alarms;
  analysis::Interval type_one{};
  /// Mean width of the 95 % t interval of the mean difference, clipped to the scale; empty if no
  /// sample has one.
  std::optional<double> width;
  int without_interval =
      0;  ///< samples without an interval, because they have fewer than two differences
};

struct RatingRow {
  int participants = 0;
  double attainable = 0.0;              ///< attainable_error()
  std::vector<DifferencePower> scales;  ///< in the order of the pool
};

/// The minimum number of participants for which sign flips can give a p of `alpha` or less.
/// \param alpha  in (0, 1)
[[nodiscard]] int min_participants(double alpha);

/// The maximum type-I error of sign flips with this number of participants.
/// \param alpha  in (0, 1)
[[nodiscard]] double attainable_error(int participants, double alpha);

/// Computes one row per size. A sample draws participants from the pool with replacement, the same
/// participants for every scale.
/// \pre the pool has at least one participant
/// \param jobs  number of threads; does not affect results
[[nodiscard]] std::vector<RatingRow> rows_of(const RatingPool& pool, const RatingPlan& plan,
                                             int jobs);

/// The setting of a power analysis, for reports.
struct RatingPlanSetting {
  std::string study;
  std::string subject;   ///< words_of the subject model
  std::string first;     ///< label of the first method
  std::string second;    ///< label of the second method
  std::string device{};  ///< analysis::device_words of the subject's device
};

struct RatingPlanReport {
  RatingPlanSetting setting;
  RatingPlan plan;
  RatingPool pool;
  std::vector<RatingRow> rows;
};

/// The curve of studies with a significant difference, with one series for each scale.
[[nodiscard]] PowerCurve rating_power_curve(const RatingPlanReport& report);
[[nodiscard]] std::string rating_plan_text(const RatingPlanReport& report);
[[nodiscard]] std::string rating_plan_json(const RatingPlanReport& report);

}  // namespace touchtrial::planning::rating
