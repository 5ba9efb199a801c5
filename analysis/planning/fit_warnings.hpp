/// \file What a fit's data cannot tell. Private to analysis/planning.
#pragma once

#include "analysis/planning/subject_fit.hpp"

#include <string>
#include <vector>

namespace touchtrial::planning {

/// Warnings of a finished fit, one line each.
/// \param free  as asked for  \param used  as could be estimated
[[nodiscard]] std::vector<std::string> fit_warnings(const FitCounts& counts, const SubjectFit& fit,
                                                    const FreeParameters& free,
                                                    const FreeParameters& used);

}  // namespace touchtrial::planning
