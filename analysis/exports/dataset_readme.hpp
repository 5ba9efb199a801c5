/// \file What whoever finds a dataset reads first. Private to exports.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <string>

namespace touchtrial::analysis {

/// Plain text.
[[nodiscard]] std::string bids_readme(const DatasetSource& study, const DatasetOptions& options);

/// Markdown.
[[nodiscard]] std::string psych_ds_readme(const DatasetSource& study);

}  // namespace touchtrial::analysis
