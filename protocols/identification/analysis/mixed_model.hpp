/// \file A table of trials, and the R script that fits a mixed model to it. Format: docs/exports.md.
#pragma once

#include "analysis/report/results.hpp"

#include <string>
#include <string_view>

namespace touchtrial::analysis::identification {

/// The lme4 formula that the script fits first. Participants have random effects for everything
/// that is compared. Images are fixed effects if there are fewer than ten, otherwise random
/// effects.
[[nodiscard]] std::string mixed_model_formula(const Outcomes& outcomes);

/// The constant part of the script: mixed_model_functions.R.
[[nodiscard]] std::string_view mixed_model_functions() noexcept;

/// The table has one row per counted trial.
[[nodiscard]] RModel mixed_model(const Outcomes& outcomes);

}  // namespace touchtrial::analysis::identification
