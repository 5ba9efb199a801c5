/// \file What an import tells people. Private to stimuli/import.
#pragma once

#include "stimuli/import/import_checks.hpp"
#include "stimuli/import/import_files.hpp"

#include <string>
#include <vector>

namespace touchtrial::stimuli {

/// Waves shorter than this are finer than devices render well.
inline constexpr double kFinestFeatureMm = 1.0;
/// Fewer waves than this across a picture are blobs, not a texture.
inline constexpr double kFewestFeatures = 8.0;

/// \param shares  crops of each of the class's photographs
[[nodiscard]] ImportedClass class_figures(const SizedClass& one, const std::vector<int>& shares,
                                          const ImportRecord& record, const ImportOptions& options);

[[nodiscard]] std::vector<std::string> import_warnings(const std::vector<ImportedClass>& classes,
                                                       const ImportRecord& record,
                                                       const ImportOptions& options);

}  // namespace touchtrial::stimuli
