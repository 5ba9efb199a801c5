/// \file Notes on a file's chain that are not faults: a station's clock that was set back, which
/// makes times and the order of sessions uncertain; accepted losses; and moves of the second head
/// file.
#pragma once

#include "record/study_store.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Returns one line per note, with chain and event. In a collected study, it reads the stations'
/// chains. Clock steps of up to a second are ignored, because two programs recording at once can
/// cause them; so are clock steps of simulated studies, whose times are meaningless.
/// \throws StoreError if a chain cannot be read
[[nodiscard]] std::vector<std::string> chain_notes(const record::StudyStore& store);

}  // namespace touchtrial::analysis
