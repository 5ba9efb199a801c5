/// \file A table of ratings, and the R script that fits a linear mixed model to it, with random
/// effects of participants. Sources: Bates, Maechler, Bolker, Walker 2015, Journal of Statistical
/// Software 67(1); docs/rating.md.
#pragma once

#include "analysis/report/results.hpp"

#include <string_view>

namespace touchtrial::analysis::rating {

/// The constant part of the script: rating_model_functions.R.
[[nodiscard]] std::string_view rating_model_functions() noexcept;

[[nodiscard]] RModel rating_model(const Outcomes& outcomes);

}  // namespace touchtrial::analysis::rating
