/// \file The checks before an import reads or writes, and its report and warnings afterwards.
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
/// \param options  with every path filled in
/// \throws UsageError if not
void check_import(const ImportOptions& options);

/// Checks that there are 2 to 64 classes, and no more stimuli than a study may have.
/// \throws FileError if not
void check_classes(const PhotoFolder& folder, const ImportOptions& options);

/// The photographs of one class after resampling.
struct SizedClass {
  std::string label;
  std::vector<std::filesystem::path> files;
  std::vector<PhotoSize> sizes;
};

/// The fault of a photograph that is smaller than a crop, without a remedy; else empty.
[[nodiscard]] std::string fault_of_size(const Photograph& photo, PhotoSize size,
                                        const ImportOptions& options);

/// The number of crops of each photograph of each class.
/// \param small  the faults of photographs that are smaller than a crop
/// \throws CropsDoNotFit if there are any, or classes give too few crops
[[nodiscard]] std::vector<std::vector<int>> plan_shares(const std::vector<SizedClass>& classes,
                                                        std::vector<std::string> small,
                                                        const ImportOptions& options);

/// The class's part of the report.
/// \param shares  the number of crops of each of the class's photographs
[[nodiscard]] ImportedClass summary_of(const SizedClass& one, const std::vector<int>& shares,
                                       const ImportRecord& record, const ImportOptions& options);

/// \param report  with its classes and ignored files
/// \return warnings, one line each
[[nodiscard]] std::vector<std::string> import_warnings(const ImportReport& report,
                                                       const ImportRecord& record,
                                                       const ImportOptions& options);

}  // namespace touchtrial::stimuli
