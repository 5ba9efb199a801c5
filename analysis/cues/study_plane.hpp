/// \file The plane that participants explored, from whatever is left of a study.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace touchtrial::analysis {

struct StudyPlane {
  PlaneGeometry geometry;
  std::string source;  ///< in words: "the study's pack"
};

/// The pack that the database was recorded with, at `folder` or, if that is empty, where the key
/// says; nothing if none is there, or it is another.
[[nodiscard]] std::optional<engine::Pack> pack_of(const store::StudyStore& store,
                                                  const design::StudyKey& key,
                                                  const std::filesystem::path& folder = {});

/// The part of the plane that all stimuli have, which is what a session tells its participant to
/// explore: from the pack's headers, else from the study's images; nothing if neither can be read.
[[nodiscard]] std::optional<StudyPlane> study_plane(const design::StudyKey& key,
                                                    const std::optional<engine::Pack>& pack);

}  // namespace touchtrial::analysis
