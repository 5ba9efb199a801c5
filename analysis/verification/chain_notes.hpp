/// \file What is worth knowing of a file's chain, and no fault: where a station's wall clock went
/// back, so that times and orders of sessions that follow from it are uncertain, which losses were
/// accepted, and where the second head file was moved to.
#pragma once

#include "record/study_store.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One line for each place, with chain and event. In a collected study, the chains of the stations.
/// Steps of the clock of up to a second are left out, as two programs that record at once may cause
/// them, and so are those of simulated studies, whose times mean nothing.
/// \throws StoreError if a chain cannot be read
[[nodiscard]] std::vector<std::string> chain_notes(const record::StudyStore& store);

}  // namespace touchtrial::analysis
