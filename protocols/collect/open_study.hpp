/// \file A study to be read, wherever it is kept.
#pragma once

#include "protocols/collect/collect.hpp"
#include "protocols/store/study_store.hpp"

#include <string>

namespace touchtrial {

/// Opens a database file as StudyStore::open does for reading.
/// \param where  a path
/// \param traces  whether whoever reads a study that is kept elsewhere wants all of its traces
/// \throws what StudyStore::open throws
[[nodiscard]] StudyStore open_study(const std::string& where, TraceUse traces = TraceUse::fetched);

}  // namespace touchtrial
