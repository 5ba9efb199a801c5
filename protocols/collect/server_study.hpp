/// \file The study and its stations on a server, as a push asks for them, changes them, and checks
/// what has arrived. Private to protocols/collect.
#pragma once

#include "core/public_keys.hpp"
#include "protocols/collect/server_connection.hpp"
#include "protocols/collect/server_rows.hpp"
#include "protocols/collect/station_course.hpp"
#include "protocols/store/study_store.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::collect {

/// The session number under which a station's file chain is stored.
[[nodiscard]] constexpr int chain_number(int station) {
  return -station;
}

/// The number of a station's session on the server. It follows from the session's own, so that no
/// station can take another's number or use them up. The schema's touchtrial_station_of agrees.
/// \throws StoreError if there are more than 100,000 sessions or 20,000 stations
[[nodiscard]] int server_session(const ServerConnection& server, int station, int own_session);

/// Until the transaction ends, nobody else changes this station.
/// \throws StoreError if the role is neither a station of the study nor its owner
void lock_station(ServerWork& work, const Digest& identity);
[[nodiscard]] std::optional<int> find_station(ServerWork& work, const Digest& identity);
/// \param commitment  first event of its file chain
/// \throws StoreError if the server has another study, or the role is another station
[[nodiscard]] int register_station(ServerWork& work, const ServerConnection& server,
                                   const Digest& identity, const std::string& name,
                                   const store::Event& commitment);
/// \throws StoreError if the server has another study
void refuse_other_study(ServerWork& work, const ServerConnection& server,
                        const store::Event& commitment);

[[nodiscard]] store::ChainHead chain_head(ServerWork& work, int station);
/// The sequence of the first event that differs in the server's copy of a chain; nothing if one of
/// the two chains begins with the other.
[[nodiscard]] std::optional<std::int64_t> parting(ServerWork& work, int station,
                                                  std::span<const store::Event> file_chain);

/// \pre the station's file chain on the server ends before this session does
/// \throws DamagedStore if the server has the session: it then lost the end of the chain
/// \throws StoreError, naming the other session, if the participant or enrolment number is taken by
///   a session that nobody replaced
void refuse_if_there_or_taken(ServerWork& work, const ServerConnection& server,
                              const store::SessionRow& row);

/// Brings a stored session up to date with the chain: exclusion, replacement, withdrawal, and the
/// keys that this destroyed.
/// \param course  course_until where the chain has been pushed to
/// \return whether a key was destroyed
bool update_session(ServerWork& work, int station, int own_session,
                    const store::SessionOnFile& course);

/// Destroys a stored session's key.
/// \param session  on the server
/// \param of_safety  the safety key, else the participant's
/// \return whether it was there
bool destroy_key(ServerWork& work, int session, bool of_safety);

/// The sessions of a station on the server: number there and own number.
[[nodiscard]] std::vector<std::pair<int, int>> sessions_of_station(ServerWork& work, int station);

/// Reads an arrived session back, in the transaction that brought it, and checks: every hash,
/// length and head as the file chain says, study and seal those of the commitment, traces those
/// that the events name, and the keys those that the session was opened with, less those destroyed
/// since.
/// \param course  course_until where the chain has been pushed to
/// \param sent  insert_traces' result
/// \param investigator  the investigator's keys, if known: the session's sealed end is then opened
///   as well
/// \throws StoreError naming what does not hold
void check_session_arrival(ServerWork& work, const ServerConnection& server, int session,
                           int own_session, const store::SessionOnFile& course,
                           const store::StudyCommitment& commitment,
                           const std::map<std::int64_t, SentTrace>& sent,
                           const std::optional<BoxKeys>& investigator);

/// Reads an arrived part of a file chain back, in the transaction that brought it, and checks every
/// hash, and that it ends as the station's chain does.
/// \param file_chain  the station's chain up to where it has been pushed
/// \param first  sequence from which on it was pushed now
/// \throws StoreError
void check_chain_arrival(ServerWork& work, const ServerConnection& server, int station,
                         std::span<const store::Event> file_chain, std::int64_t first);

}  // namespace touchtrial::collect
