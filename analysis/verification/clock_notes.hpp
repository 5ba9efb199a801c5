/// \file Where a station's wall clock went back: events of the file's chain that are dated before
/// the event before them. Nobody's evidence is damaged by that, but times and orders of sessions
/// that follow from them are uncertain.
#pragma once

#include "protocols/store/study_store.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One line for each place, with chain, event and both times. In a collected study, the chains of
/// the stations, each of which has one clock. Steps of up to a second are left out, as two programs
/// that record at once may cause them, and so are simulated studies, whose times mean nothing.
/// \throws StoreError if a chain cannot be read
[[nodiscard]] std::vector<std::string> clock_notes(const store::StudyStore& store);

}  // namespace touchtrial::analysis
