/// \file Notes on a file's chain that are not faults: where a station's wall clock went back, which
/// makes times and orders of sessions uncertain, which losses were accepted, and where the second
/// head file was moved to.
#pragma once

#include "record/study_store.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One line for each note, with chain and event. In a collected study, the chains of the stations
/// are read. Clock steps of up to a second are ignored, because two programs recording at once can
/// cause them. So are those of simulated studies, whose times are meaningless.
/// \throws StoreError if a chain cannot be read
[[nodiscard]] std::vector<std::string> chain_notes(const record::StudyStore& store);

}  // namespace touchtrial::analysis
