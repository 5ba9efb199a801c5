/// \file The numbers by which an identification study compares its methods, for its page and its
/// results.json. The lists refer to a report, which must outlive them.
#pragma once

#include "analysis/report/measure.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <cstddef>

namespace touchtrial::analysis::identification {

[[nodiscard]] MeasureList<MethodReport> headline_measures(const StudyReport& report);
[[nodiscard]] MeasureList<MethodPair> pair_measures(const StudyReport& report);
/// Of each class, by its index.
[[nodiscard]] MeasureList<std::size_t> class_measures(const StudyReport& report,
                                                      const MethodPair& pair);

/// "25/30 83.3%"; a dash without trials.
[[nodiscard]] std::string count_and_share(const Proportion& of);

}  // namespace touchtrial::analysis::identification
