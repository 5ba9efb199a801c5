/// \file dataset_description.json of a Psych-DS dataset. Private to exports.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// \param columns  of all data files; each is described once
[[nodiscard]] std::string psych_ds_description_json(const DatasetSource& study,
                                                    const DatasetOptions& options,
                                                    const std::vector<std::string>& columns);

}  // namespace touchtrial::analysis
