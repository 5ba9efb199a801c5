/// \file Figures of rating reports.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/rating/analysis/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis::rating {

/// The pictures of the classes, with sides of up to kPictureSide_px; empty for a class without a
/// picture.
using ItemPictures = std::vector<GreyImage>;
inline constexpr int kPictureSide_px = 110;

/// All figures with data, in the order of a results section, not yet drawn.
/// \param pictures  may be empty
/// \param stamp  on every figure in addition to SIMULATED; may be empty
[[nodiscard]] std::vector<Figure> report_figures(const RatingReport& report,
                                                 const ItemPictures& pictures,
                                                 const std::string& stamp);

/// Ratings by texture and method: participants' means, their mean and interval, above the pictures.
/// \return nothing without a rating
[[nodiscard]] std::optional<Figure> ratings_figure(const RatingReport& report,
                                                   const ScaleReport& scale,
                                                   const ItemPictures& pictures);

}  // namespace touchtrial::analysis::rating
