#include "protocols/identification/analysis/cues/study_plane.hpp"

#include "core/errors.hpp"
#include "engine/image_file.hpp"

#include <algorithm>

namespace touchtrial::analysis::identification {

namespace {

/// Reduces `common` to the part that both planes have. If `common` is empty, it becomes the other
/// plane.
void keep_common(PlaneGeometry& common, const PlaneGeometry& other) {
  const bool first = common.height_px == 0;
  common.pitch_mm = first ? other.pitch_mm : common.pitch_mm;
  common.height_px = first ? other.height_px : std::min(common.height_px, other.height_px);
  common.width_px = first ? other.width_px : std::min(common.width_px, other.width_px);
}

PlaneGeometry plane_of_pack(const engine::Pack& pack) {
  PlaneGeometry common;
  for (const engine::PackEntry& entry : pack.manifest().entries) {
    keep_common(common, pack.map(entry.code).view().geometry);
  }
  return common;
}

PlaneGeometry plane_of_images(const study::Study& study) {
  PlaneGeometry common;
  for (const study::StudyClass& one : study.classes) {
    for (const auto& image : one.images) {
      const GreyImage picture = engine::read_grey_image(study.folder / image);
      keep_common(common, {study.rendering.pitch_mm, picture.height(), picture.width()});
    }
  }
  return common;
}

template <typename Make>
std::optional<StudyPlane> if_readable(const char* source, Make make) {
  try {
    const PlaneGeometry geometry = make();
    if (geometry.height_px > 0) return StudyPlane{geometry, source};
  } catch (const FileError&) {
    // Without the file the caller tries another source.
  }
  return std::nullopt;
}

}  // namespace

std::optional<engine::Pack> pack_of(const record::StudyStore& store, const study::StudyKey& key,
                                    const std::filesystem::path& folder) {
  try {
    engine::Pack pack(folder.empty() ? key.pack_folder : folder);
    if (pack.digest() == store.commitment().pack) return pack;
  } catch (const FileError&) {
    // A pack that cannot be read counts as none.
  }
  return std::nullopt;
}

std::optional<StudyPlane> study_plane(const study::StudyKey& key,
                                      const std::optional<engine::Pack>& pack) {
  if (pack) {
    if (auto plane = if_readable("the study's pack", [&] { return plane_of_pack(*pack); })) {
      return plane;
    }
  }
  return if_readable("the study's images", [&] { return plane_of_images(key.study); });
}

}  // namespace touchtrial::analysis::identification
