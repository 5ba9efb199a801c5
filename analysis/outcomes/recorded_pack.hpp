/// \file Finds the pack that a database was recorded with.
#pragma once

#include "engine/pack/pack.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <optional>

namespace touchtrial::analysis {

/// Opens the pack that the database was recorded with.
/// \param folder  the pack's folder; empty: the path in the key
/// \return nothing if the pack is unreadable or a different pack
[[nodiscard]] std::optional<engine::Pack> pack_of(const record::StudyStore& store,
                                                  const study::StudyKey& key,
                                                  const std::filesystem::path& folder = {});

}  // namespace touchtrial::analysis
