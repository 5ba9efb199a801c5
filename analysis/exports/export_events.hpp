/// \file What happened in sessions beside their trials, for whoever has to explain it: remarks,
/// breaks, pauses, and the last seconds before every interruption.
/// Format: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/outcomes.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::analysis {

/// Writes events.csv and one file for each flight record, of the sessions that outcomes may be
/// shown of and that have not withdrawn. Forces before a fault tell textures apart, so that there
/// is none of it before unblinding.
/// \param outcomes  of this store, opened with `key`
/// \return the files, in the order written
/// \throws VerificationError, naming the event, if a sealed part does not open
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_events(const store::StudyStore& store,
                                                 const design::StudyKey& key,
                                                 const Outcomes& outcomes,
                                                 const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
