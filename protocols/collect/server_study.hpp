/// \file The study and its stations on a server. Private to protocols/collect.
#pragma once

#include "core/hash.hpp"
#include "protocols/collect/server_connection.hpp"
#include "protocols/collect/station_course.hpp"
#include "protocols/store/study_store.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::collect {

/// The session number under which a station's file chain is kept.
[[nodiscard]] constexpr int chain_number(int station) {
  return -station;
}

/// Until the transaction ends, nobody else changes this station.
void lock_station(pqxx::work& work, const Digest& identity);
[[nodiscard]] std::optional<int> find_station(pqxx::work& work, const Digest& identity);
/// \param commitment  first event of its file chain
/// \throws StoreError if the server has another study
[[nodiscard]] int register_station(pqxx::work& work, const ServerConnection& server,
                                   const Digest& identity, const std::string& name,
                                   const store::Event& commitment);
/// \throws StoreError if there is a study, and it is another
void refuse_other_study(pqxx::work& work, const ServerConnection& server,
                        const store::Event& commitment);

[[nodiscard]] store::ChainHead chain_head(pqxx::work& work, int station);
/// The first event at which the server's copy of a chain is another one; nothing if one of the two
/// is the beginning of the other.
[[nodiscard]] std::optional<std::int64_t> parting(pqxx::work& work, int station,
                                                  std::span<const store::Event> file_chain);

/// \pre the station's file chain on the server ends before this session does
/// \throws DamagedStore if this very session is there: the server's end of the chain is gone
void refuse_if_cut_off(pqxx::work& work, const ServerConnection& server,
                       const store::SessionRow& row);

/// \throws StoreError, naming the session that is there, if its participant or enrolment number is
///   taken by one that nobody replaced
void refuse_if_taken(pqxx::work& work, const ServerConnection& server,
                     const store::SessionRow& row);

/// Brings a session that is there up to date with the chain up to `end`: exclusion, replacement,
/// withdrawal, which destroys its key.
/// \return whether a key was destroyed
bool update_session(pqxx::work& work, int station, int own_session, const SessionCourse& course,
                    std::int64_t end);

/// The key of a session that is there and was not withdrawn there.
struct KeyThere {
  int session = 0;  ///< on the server
  int own_session = 0;
  Bytes digest;  ///< SHA-256 of the wrapped key; empty: it is gone
};
[[nodiscard]] std::vector<KeyThere> keys_of_station(pqxx::work& work, int station);

}  // namespace touchtrial::collect
