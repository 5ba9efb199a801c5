/// \file Exports a long table of ratings and the R script that fits a linear mixed model to it,
/// with random effects of participants. Sources: Bates, Maechler, Bolker, Walker 2015, Journal of
/// Statistical Software 67(1); docs/rating.md.
#pragma once

#include "analysis/outcomes/outcomes.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis::rating {

/// The part of the script that is the same for every study: rating_model_functions.R, built in.
[[nodiscard]] std::string_view rating_model_functions() noexcept;

/// The text of rating_model.R.
[[nodiscard]] std::string rating_model_script(const Outcomes& outcomes);

/// Writes rating_model.csv, rating_model.R and rating_model.md.
/// \return the files, in the order written
/// \throws FileError as write_export does
std::vector<std::filesystem::path> export_rating_model(const record::StudyStore& store,
                                                       const Outcomes& outcomes,
                                                       const std::filesystem::path& folder);

}  // namespace touchtrial::analysis::rating
