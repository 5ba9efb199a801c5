/// \file The photographs of a folder: their classes, and each one upright, grey, and resampled to
///   its felt size. Private to stimuli/import.
#pragma once

#include "core/hash.hpp"
#include "core/plane.hpp"
#include "engine/image_notes.hpp"
#include "stimuli/import/crop_plan.hpp"
#include "stimuli/import/import.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::stimuli {

/// The photographs of one label, in natural order of their names.
struct PhotoClass {
  std::string label;
  std::vector<std::filesystem::path> files;
};

struct PhotoFolder {
  std::vector<PhotoClass> classes;   ///< in natural order of their labels
  std::vector<std::string> ignored;  ///< names of other files
  std::vector<std::string> faults;   ///< of names, one line each; such files are unusable
};

/// In a folder of folders, each folder is a class of its name. In a folder of files, each file is a
/// class of its stem, as in an album of D1.png, D2.png, ... Hidden files and folders do not count;
/// files that neither begin as a picture nor have the ending of one are ignored.
/// \param names  how the files of an album are named, without their endings: `{class}` is the label,
///   `#` a number and `*` any text; empty: each file is a class of its stem
/// \throws UsageError if `names` lacks {class} or has it twice
/// Files that have other names, lie beside folders, or whose name cannot be a label or looks like
/// another (skeleton_of) are faults.
/// \throws FileError if `folder` is not a folder, cannot be listed, or is empty
[[nodiscard]] PhotoFolder list_photographs(const std::filesystem::path& folder,
                                           const std::string& names = {});

/// Whether `a` comes before `b` when numbers count as numbers: D2 before D10.
[[nodiscard]] bool naturally_before(const std::string& a, const std::string& b);

/// A photograph, and the content of its manifest entry.
struct Photograph {
  std::filesystem::path path;
  Digest sha256{};           ///< of the file
  Digest pixels_sha256{};    ///< of shape and grey levels, upright, before resampling
  engine::ImageNotes notes;  ///< the image is turned upright by its orientation
  int height_px = 0;         ///< upright, before resampling
  int width_px = 0;
  std::optional<PhotoPart> opaque;  ///< of a transparent photograph, the only part used
  double scale = 1.0;               ///< of the resampling, new pixels per old pixel
  GreyImage image;                  ///< upright and resampled; its opaque part
};

/// \throws FileError if the file cannot be read, does not state its resolution although the options
///   ask for it, has no opaque pixel, or needs scaling beyond 1/64 to 4
[[nodiscard]] Photograph read_photograph(const std::filesystem::path& path,
                                         const ImportOptions& options);

}  // namespace touchtrial::stimuli
