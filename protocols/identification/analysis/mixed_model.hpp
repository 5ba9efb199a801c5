/// \file Exports a long table for a mixed model in R with the script that fits it. Format:
/// docs/exports.md.
#pragma once

#include "analysis/outcomes/outcomes.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis::identification {

/// The model that the script fits first, as an lme4 formula. Participants have random effects of
/// everything that is compared. Images are fixed effects if there are fewer than ten, and random
/// effects otherwise.
[[nodiscard]] std::string mixed_model_formula(const Outcomes& outcomes);

/// The part of the script that is the same for every study: mixed_model_functions.R, built in.
[[nodiscard]] std::string_view mixed_model_functions() noexcept;

/// The text of mixed_model.R.
[[nodiscard]] std::string mixed_model_script(const Outcomes& outcomes);

/// Writes mixed_model.csv, mixed_model.R and mixed_model.md.
/// \return the files, in the order written
/// \throws FileError if the folder or a file cannot be written, or the folder holds other files
std::vector<std::filesystem::path> export_mixed_model(const record::StudyStore& store,
                                                      const Outcomes& outcomes,
                                                      const std::filesystem::path& folder);

}  // namespace touchtrial::analysis::identification
