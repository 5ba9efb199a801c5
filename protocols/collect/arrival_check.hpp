/// \file What has arrived on a server, read back in the transaction that brought it and held
/// against the chains that say what it must be. Private to protocols/collect.
#pragma once

#include "core/cipher.hpp"
#include "protocols/collect/server_connection.hpp"
#include "protocols/collect/station_course.hpp"

#include <optional>
#include <span>

namespace touchtrial::collect {

/// A session: every hash recomputed, length and head as the file chain says, study and seal those
/// of the commitment, its traces those that its events name, its key the one that it was opened
/// with. \param master  the study's key: its sealed end is opened as well \param has_key  whether
/// its key must be there \throws StoreError naming what does not hold
void check_session_arrival(pqxx::work& work, const ServerConnection& server, int session,
                           int own_session, const SessionCourse& course,
                           const store::StudyCommitment& commitment,
                           const std::optional<SecretKey>& master, bool has_key);

/// The file chain from `first` on: every hash recomputed, and the end that of the station.
/// \param file_chain  up to where it has been pushed
void check_chain_arrival(pqxx::work& work, const ServerConnection& server, int station,
                         std::span<const store::Event> file_chain, std::int64_t first);

}  // namespace touchtrial::collect
