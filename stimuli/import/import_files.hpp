/// \file Writes the two JSON files of an import. Private to stimuli/import.
/// Format: docs/data-dictionary.md, "Imported pictures", and docs/study-file.md.
#pragma once

#include "core/hash.hpp"
#include "stimuli/import/crop_plan.hpp"
#include "stimuli/import/photographs.hpp"
#include "stimuli/import/picture_levels.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::stimuli {

inline constexpr std::string_view kImportFormat = "touchtrial-import";

/// A photograph of the import, without its pixels.
struct ImportedPhotograph {
  std::string file;   ///< path relative to the folder of photographs, with forward slashes
  Photograph photo;   ///< the image is empty
  PhotoSize size_px;  ///< after resampling
};

/// A crop that was written.
struct ImportedPicture {
  std::string label;
  std::string file;  ///< name in the folder of pictures
  std::size_t photograph = 0;
  CropPosition position;
  PictureLevels levels;  ///< before equalising
  double clipped_share = 0.0;
  Digest sha256{};
  Digest pixels_sha256{};  ///< of the grey levels, row-major
};

/// Everything read and written by an import.
struct ImportRecord {
  std::vector<ImportedPhotograph> photographs;
  std::vector<ImportedPicture> pictures;  ///< grouped by class
  EqualLevels target_levels;
};

/// The text of manifest.json.
/// \param remarks  on the photographs and crops, as printed
[[nodiscard]] std::string manifest_text(const ImportRecord& record, const ImportOptions& options,
                                        const std::vector<std::string>& remarks);

/// The text of the study file.
/// \param name  of the study, valid in study files
/// \param folder  of the pictures, relative to the study file
[[nodiscard]] std::string study_file_text(const ImportRecord& record, const ImportOptions& options,
                                          const std::string& name,
                                          const std::filesystem::path& folder);

}  // namespace touchtrial::stimuli
