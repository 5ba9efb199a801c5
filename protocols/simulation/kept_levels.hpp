/// \file A study's levels, computed once and kept.
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/simulation/stimulus_levels.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::simulation {

/// levels_of, but looked up if they were computed before for this key, study, pack and these
/// devices. Takes the pack's list at its word: for a pack that was just prepared.
/// \param notes  folder of design::PrivateNotes; empty: computes them
/// \throws FileError as levels_of and session::StimulusSource
[[nodiscard]] StimulusLevels kept_levels_of(const design::StudyKey& key, const engine::Pack& pack,
                                            const std::vector<device::DeviceModel>& devices,
                                            int jobs, const std::filesystem::path& notes);

}  // namespace touchtrial::simulation
