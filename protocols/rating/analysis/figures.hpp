/// \file The figures of a rating study's report.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/rating/analysis/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis::rating {

/// The figures that have something to show, in the order of a results section. Their scripts
/// contain all data, and no figure is drawn yet.
/// \param stamp  on every figure besides SIMULATED; may be empty
[[nodiscard]] std::vector<Figure> report_figures(const RatingReport& report,
                                                 const std::string& stamp);

/// Ratings by texture and method: participants' means, their mean and its interval.
/// \return nothing without a rating
[[nodiscard]] std::optional<Figure> ratings_figure(const RatingReport& report,
                                                   const ScaleReport& scale);

}  // namespace touchtrial::analysis::rating
