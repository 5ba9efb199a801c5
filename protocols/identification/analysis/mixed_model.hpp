/// \file A long table for a mixed model in R, and the script that fits it.
/// Format: docs/exports.md.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/outcomes.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// One row a trial that counts, in the order of presentation, with what came before it in its block
/// (a lead-in too; nothing after a catch trial).
[[nodiscard]] DataTable mixed_model_table(const Outcomes& outcomes);

/// The model as lme4 takes it: participants and images are random, methods fixed where several are
/// compared.
[[nodiscard]] std::string mixed_model_formula(const Outcomes& outcomes);

/// mixed_model.R.
[[nodiscard]] std::string mixed_model_script(const Outcomes& outcomes);

/// Writes mixed_model.csv, mixed_model.R and mixed_model.md.
/// \return the files, in the order written
/// \throws FileError if the folder or a file cannot be written or holds something else's files
std::vector<std::filesystem::path> export_mixed_model(const store::StudyStore& store,
                                                      const Outcomes& outcomes,
                                                      const std::filesystem::path& folder);

}  // namespace touchtrial::analysis::identification
