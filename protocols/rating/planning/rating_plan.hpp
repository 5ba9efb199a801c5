/// \file How often the difference of two methods' ratings is found with a number of participants,
/// and how wide its interval is. Source: docs/planning.md, "Power of rating studies".
#pragma once

#include "analysis/statistics/proportion.hpp"
#include "protocols/rating/planning/rating_pool.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::planning::rating {

struct RatingPlan {
  std::vector<int> participants;  ///< sizes, >= 2
  int runs = 1000;                ///< samples of each size, >= 1
  std::uint64_t seed = 1;         ///< of the samples
  double alpha = 0.05;            ///< of the sign-flip test, two-sided
};

/// Of one scale, over samples.
struct DifferencePower {
  analysis::Proportion significant;  ///< sign_flip_p
  analysis::Interval power{};        ///< Wilson's, 95 %
  /// The same samples with a random sign on everybody's difference.
  analysis::Proportion false_alarms;
  analysis::Interval type_one{};
  /// Mean width of the 95 % t interval of the mean difference, cut to the scale; nothing if no
  /// sample has one.
  std::optional<double> width;
  int without = 0;  ///< samples with fewer than two differences, and so no interval
};

struct RatingRow {
  int participants = 0;
  double attainable = 0.0;              ///< attainable_error
  std::vector<DifferencePower> scales;  ///< of the pool
};

/// The least number of participants of whom sign flips can give a p of `alpha` or less.
/// \param alpha  in (0, 1)
[[nodiscard]] int fewest_participants(double alpha);

/// The largest type-I error that sign flips of so many participants can have.
/// \param alpha  in (0, 1)
[[nodiscard]] double attainable_error(int participants, double alpha);

/// One row for each size. A sample draws participants of the pool, each anew from all of them, with
/// the differences that they have; it has the same participants on every scale.
/// \pre the pool has at least one participant
/// \param jobs  threads; results do not depend on them
[[nodiscard]] std::vector<RatingRow> rows_of(const RatingPool& pool, const RatingPlan& plan,
                                             int jobs);

/// What the numbers are of, in words.
struct RatingPlanSetting {
  std::string study;
  std::string subject;  ///< words_of the subject model
  std::string first;    ///< the methods' labels
  std::string second;
  std::string device{};  ///< analysis::device_words of what the subject holds
};

struct RatingPlanReport {
  RatingPlanSetting setting;
  RatingPlan plan;
  RatingPool pool;
  std::vector<RatingRow> rows;
};

[[nodiscard]] std::string rating_plan_text(const RatingPlanReport& report);
[[nodiscard]] std::string rating_plan_json(const RatingPlanReport& report);

}  // namespace touchtrial::planning::rating
