/// \file The derived tables on a server, held against a study that was collected from its events.
/// Private to protocols/collect.
#pragma once

#include "protocols/collect/server_connection.hpp"
#include "protocols/store/study_store.hpp"

namespace touchtrial::collect {

/// \param collected  from the same server, at the same moment
/// \throws DamagedStore naming station and session at which sessions, trials or responses are not
///   what the events come to
void check_derived(pqxx::work& work, const ServerConnection& server,
                   const store::StudyStore& collected);

}  // namespace touchtrial::collect
