/// \file A study to be read, wherever it is kept.
#pragma once

#include "protocols/collect/collect.hpp"
#include "protocols/store/study_store.hpp"

#include <string>

namespace touchtrial::collect {

/// Opens a database file as StudyStore::open does for reading, or collects what a server has of all
/// stations into a private temporary database.
/// \param where  a path, or a postgresql:// address
/// \param traces  whether whoever reads a study that is kept elsewhere wants all of its traces
/// \throws what StudyStore::open throws; also what ServerAddress, stations_of_server and
///   collected_for_reading throw
[[nodiscard]] store::StudyStore open_study(const std::string& where,
                                           TraceUse traces = TraceUse::fetched);

/// What a study is called in reports: the name of its file, or the address of its server without
/// user. \throws what ServerAddress throws
[[nodiscard]] std::string study_name(const std::string& where);

}  // namespace touchtrial::collect
