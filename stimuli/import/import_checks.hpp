/// \file Checks the options of an import, plans its crops, and makes its report and warnings.
/// Private to stimuli/import.
#pragma once

#include "stimuli/import/crop_plan.hpp"
#include "stimuli/import/import.hpp"
#include "stimuli/import/import_files.hpp"
#include "stimuli/import/photographs.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::stimuli {

/// Checks that the options are in range, their texts are UTF-8, and the outputs may be written.
/// \param options  with all paths set
/// \throws UsageError if not
void check_import(const ImportOptions& options);

/// Checks that there are 2 to 64 classes and not too many stimuli for a study.
/// \throws FileError if not
void check_classes(const PhotoFolder& folder, const ImportOptions& options);

/// The photographs of one class after resampling.
struct SizedClass {
  std::string label;
  std::vector<std::filesystem::path> files;
  std::vector<PhotoSize> sizes;
};

/// The error message for a photograph smaller than a crop, without a remedy; empty if it fits.
[[nodiscard]] std::string fault_of_size(const Photograph& photo, PhotoSize size,
                                        const ImportOptions& options);

/// The number of crops from each photograph of each class.
/// \param size_faults  faults of photographs smaller than a crop
/// \throws CropsDoNotFit if `size_faults` is not empty, or classes give too few crops
[[nodiscard]] std::vector<std::vector<int>> plan_crops(const std::vector<SizedClass>& classes,
                                                       std::vector<std::string> size_faults,
                                                       const ImportOptions& options);

/// Summarises one class for the report.
/// \param crop_counts  number of crops from each photograph of the class
[[nodiscard]] ImportedClass summary_of(const SizedClass& photo_class,
                                       const std::vector<int>& crop_counts,
                                       const ImportRecord& record, const ImportOptions& options);

/// \param report  with its classes and ignored files
/// \return warnings, one line each
[[nodiscard]] std::vector<std::string> import_warnings(const ImportReport& report,
                                                       const ImportRecord& record,
                                                       const ImportOptions& options);

}  // namespace touchtrial::stimuli
