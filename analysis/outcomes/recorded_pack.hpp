/// \file Finds the pack with which a database was recorded.
#pragma once

#include "engine/pack/pack.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <optional>

namespace touchtrial::analysis {

/// The pack with which the database was recorded.
/// \param folder  empty: the path in the key
/// \return nothing if there is no pack, or the pack is a different one
[[nodiscard]] std::optional<engine::Pack> pack_of(const record::StudyStore& store,
                                                  const study::StudyKey& key,
                                                  const std::filesystem::path& folder = {});

}  // namespace touchtrial::analysis
