/// \file A long table of ratings with the R script that fits a linear mixed model to it,
/// with random effects of participants. Sources: Bates, Maechler, Bolker, Walker 2015, Journal of
/// Statistical Software 67(1); docs/rating.md.
#pragma once

#include "analysis/report/results.hpp"

#include <string_view>

namespace touchtrial::analysis::rating {

/// The part of the script that is the same for every study: rating_model_functions.R, built in.
[[nodiscard]] std::string_view rating_model_functions() noexcept;

[[nodiscard]] RModel rating_model(const Outcomes& outcomes);

}  // namespace touchtrial::analysis::rating
