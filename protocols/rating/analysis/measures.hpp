/// \file The measures of a rating study, for its page and results.json.
#pragma once

#include "analysis/report/listed_measures.hpp"
#include "protocols/rating/analysis/report.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace touchtrial::analysis::rating {

inline constexpr int kRatingDecimals = 2;
inline constexpr int kCorrelationDecimals = 2;

/// \name Lists that refer to their arguments, which must outlive them
/// \{

[[nodiscard]] MeasureList<ItemMean> item_measures(const RatingReport& report);
[[nodiscard]] MeasureList<MethodDifference> difference_measures(const RatingReport& report);
[[nodiscard]] MeasureList<CatchRating> catch_measures(const RatingReport& report);
/// Rows are indices into RatingReport::people.
[[nodiscard]] MeasureList<std::size_t> use_measures(const RatingReport& report,
                                                    const ScaleReport& scale);

/// \}

/// \param member  of results.json: "method"
/// \param labels  by GroupMean::group; must outlive the list
[[nodiscard]] MeasureList<GroupMean> group_measures(const std::string& member,
                                                    const std::vector<std::string>& labels);

/// The objects of these lists in results.json.
[[nodiscard]] std::vector<ListedObject> listed_objects();

/// Student's t of a difference; nothing if all differences are equal.
[[nodiscard]] std::optional<TStatistic> statistic_of(const MethodDifference& difference);

/// Indices into RatingReport::people.
[[nodiscard]] std::vector<std::size_t> people_indices(const RatingReport& report);

}  // namespace touchtrial::analysis::rating
