/// \file The figures of a rating study's report.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/rating/analysis/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis::rating {

/// Of each class, at most kPictureSide_px long; empty where there is none.
using ItemPictures = std::vector<GreyImage>;
inline constexpr int kPictureSide_px = 110;

/// The figures that have something to show, in the order of a results section. No figure is drawn
/// yet.
/// \param pictures  may be empty
/// \param stamp  on every figure besides SIMULATED; may be empty
[[nodiscard]] std::vector<Figure> report_figures(const RatingReport& report,
                                                 const ItemPictures& pictures,
                                                 const std::string& stamp);

/// Ratings by texture and method: participants' means, their mean and its interval, above the
/// textures' pictures.
/// \return nothing without a rating
[[nodiscard]] std::optional<Figure> ratings_figure(const RatingReport& report,
                                                   const ScaleReport& scale,
                                                   const ItemPictures& pictures);

}  // namespace touchtrial::analysis::rating
