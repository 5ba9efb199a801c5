/// \file What must hold before anything is read or written. Private to stimuli/import.
#pragma once

#include "stimuli/import/crop_plan.hpp"
#include "stimuli/import/import.hpp"
#include "stimuli/import/photo_folder.hpp"

#include <vector>

namespace touchtrial::stimuli {

/// Options in range, texts that JSON can hold, and places that may be written to.
/// \param options  with every path filled in
/// \throws UsageError
void check_import(const ImportOptions& options);

/// Two to 64 classes, and no more stimuli than a study may have.
/// \throws FileError
void check_classes(const PhotoFolder& folder, const ImportOptions& options);

/// The photographs of one class after resampling.
struct SizedClass {
  std::string label;
  std::vector<std::filesystem::path> files;
  std::vector<PhotoSize> sizes;
};

/// How many crops each photograph of each class gives.
/// \throws FileError if a photograph is smaller than a crop, or a class has too few crops; says
///   what would do
[[nodiscard]] std::vector<std::vector<int>> plan_shares(const std::vector<SizedClass>& classes,
                                                        const ImportOptions& options);

}  // namespace touchtrial::stimuli
