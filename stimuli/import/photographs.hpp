/// \file Lists the photographs of a folder by class, and reads each one upright, in grey, and
/// resampled to its felt size. Private to stimuli/import.
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
  std::vector<std::string> faults;   ///< invalid names, one line each; such files are unusable
};

/// In a folder of folders, each folder is a class. In a folder of files, each file is a class named
/// by its stem, as in an album of D1.png, D2.png, ... Skips hidden files and folders, and files
/// with neither the content nor the extension of a picture. Names that do not match `names`, are
/// not valid labels, or look like another label (skeleton_of) are faults, and so are files next
/// to folders.
/// \param names  pattern of an album's file names without extensions: `{class}` is the label, `#` a
///   number and `*` any text; empty: each file is a class
/// \throws UsageError unless `names` is empty or has {class} exactly once
/// \throws FileError if `folder` is not a folder, cannot be listed, or is empty
[[nodiscard]] PhotoFolder list_photographs(const std::filesystem::path& folder,
                                           const std::string& names = {});

/// Natural order: whether `a` sorts before `b` with digits compared as numbers (D2 before D10).
[[nodiscard]] bool naturally_before(const std::string& a, const std::string& b);

/// A photograph, and the content of its manifest entry.
struct Photograph {
  std::filesystem::path path;
  Digest sha256{};           ///< of the file
  Digest pixels_sha256{};    ///< of shape and grey levels, upright, before resampling
  engine::ImageNotes notes;  ///< with the original orientation
  int height_px = 0;         ///< upright, before resampling
  int width_px = 0;
  std::optional<PhotoPart> opaque_rectangle;  ///< the part used of a transparent photograph
  double scale = 1.0;                         ///< of the resampling, new pixels per old pixel
  GreyImage image;                            ///< upright, opaque part, resampled
};

/// \throws FileError if the file cannot be read, lacks a resolution that the options require, has
///   no opaque pixel, or needs scaling outside 1/64 to 4
[[nodiscard]] Photograph read_photograph(const std::filesystem::path& path,
                                         const ImportOptions& options);

}  // namespace touchtrial::stimuli
