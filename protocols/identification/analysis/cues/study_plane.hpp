/// \file The plane that participants explored, reconstructed from the files of the study that still
/// exist.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/pack/pack.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace touchtrial::analysis::identification {

struct StudyPlane {
  PlaneGeometry geometry;
  std::string source;  ///< in words: "the study's pack"
};

/// The pack with which the database was recorded.
/// \param folder  empty: where the key says
/// \return nothing if there is no pack, or the pack is a different one
[[nodiscard]] std::optional<engine::Pack> pack_of(const record::StudyStore& store,
                                                  const study::StudyKey& key,
                                                  const std::filesystem::path& folder = {});

/// The part of the plane that all stimuli share; a session asks its participant to explore it. The
/// size comes from the pack's headers, otherwise from the study's images.
/// \return nothing if neither can be read
[[nodiscard]] std::optional<StudyPlane> study_plane(const study::StudyKey& key,
                                                    const std::optional<engine::Pack>& pack);

}  // namespace touchtrial::analysis::identification
