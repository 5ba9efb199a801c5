/// \file A long table of trials with the R script that fits a mixed model to it. Format:
/// docs/exports.md.
#pragma once

#include "analysis/report/results.hpp"

#include <string>
#include <string_view>

namespace touchtrial::analysis::identification {

/// The model that the script fits first, as an lme4 formula. Participants have random effects of
/// everything that is compared. Images are fixed effects if there are fewer than ten, and random
/// effects otherwise.
[[nodiscard]] std::string mixed_model_formula(const Outcomes& outcomes);

/// The part of the script that is the same for every study: mixed_model_functions.R, built in.
[[nodiscard]] std::string_view mixed_model_functions() noexcept;

/// The model with its table, one row for each counted trial.
[[nodiscard]] RModel mixed_model(const Outcomes& outcomes);

}  // namespace touchtrial::analysis::identification
