/// \file Exports the events of sessions beside their trials: remarks, breaks, pauses, and the last
/// seconds before every interruption. Format: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/outcomes.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::analysis {

/// Writes events.csv and one file for each flight record. Contains the sessions whose outcomes may
/// be shown, without those of participants who withdrew. Requires unblinding, because the forces
/// before a fault can tell textures apart.
/// \param outcomes  of this store, opened with `key`
/// \return the files, in the order written
/// \throws VerificationError, naming the event, if a sealed part does not open
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_events(const store::StudyStore& store,
                                                 const design::StudyKey& key,
                                                 const Outcomes& outcomes,
                                                 const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
