#include "protocols/collect/server_study.hpp"

#include "protocols/collect/server_rows.hpp"
#include "protocols/store/damaged_store.hpp"
#include "protocols/store/event_fault.hpp"

#include <algorithm>

namespace touchtrial::collect {
namespace {

/// Of a session that stands in another's way.
struct Holder {
  int session = 0;  ///< on the server
  int own = 0;
  int station = 0;
  std::string station_name;
  std::string participant;
  int enrolment = 0;
};

std::optional<Holder> holder_of(pqxx::work& work, const store::SessionRow& row) {
  const pqxx::result found = work.exec_params(
      "SELECT s.session, coalesce(s.own_session, s.session), s.station, t.name, s.participant, "
      "s.enrolment FROM sessions s JOIN stations t USING(station) WHERE s.replaced_by IS NULL "
      "AND (s.participant = $1 OR s.enrolment = $2) ORDER BY s.participant <> $1, s.session LIMIT "
      "1",
      row.participant, row.enrolment);
  if (found.empty()) return std::nullopt;
  const pqxx::row& first = found[0];
  return Holder{.session = first[0].as<int>(),
                .own = first[1].as<int>(),
                .station = first[2].as<int>(),
                .station_name = first[3].as<std::string>(),
                .participant = first[4].as<std::string>(),
                .enrolment = first[5].as<int>()};
}

/// Of a chain's first event, as it is on the server.
template <typename Parse>
auto parsed_from(int session, const std::string& body, Parse parse) {
  try {
    return parse(body);
  } catch (const StoreError& error) {
    throw store::EventFault(session, 0, error.what());
  }
}

/// "opened 2026-01-05T10:00:00Z on falcon 1234"; what its first event says, as it is there.
std::string opening_of(pqxx::work& work, int session) {
  const pqxx::result found = work.exec_params(
      "SELECT body FROM events WHERE session = $1 AND sequence = 0 AND octet_length(body) < 65536",
      session);
  if (found.empty()) return "of which no opening is there";
  const store::SessionOpening opening =
      parsed_from(session, found[0][0].as<std::string>(), store::opening_from_json);
  std::string text = opening.opened_utc.empty() ? "" : "opened " + opening.opened_utc + " ";
  text += "on " + opening.device;
  if (!opening.device_serial.empty()) text += " " + opening.device_serial;
  return one_line(text);
}

/// What is there, where it is not the same study; stations may differ in the program's version.
std::optional<std::string> difference(const store::StudyCommitment& there,
                                      store::StudyCommitment here) {
  here.program_version = there.program_version;
  if (there == here) return std::nullopt;
  if (there.study_id != here.study_id || there.study != here.study) return "another study";
  if (there.seal != here.seal) return "this study under another seal (its key was made anew)";
  if (there.pack != here.pack) return "this study with other force fields";
  if (there.simulated != here.simulated) {
    return there.simulated ? "simulated participants" : "real participants";
  }
  if (there.pilot != here.pilot) return there.pilot ? "its pilot" : "the study and not its pilot";
  return "this study with another configuration";
}

}  // namespace

void lock_station(pqxx::work& work, const Digest& identity) {
  work.exec_params(
      "SELECT pg_advisory_xact_lock(hashtextextended('touchtrial ' || current_schema() || $1, 0))",
      to_hex(identity));
}

std::optional<int> find_station(pqxx::work& work, const Digest& identity) {
  const pqxx::result found =
      work.exec_params("SELECT station FROM stations WHERE identity = $1", binary(identity));
  if (found.empty()) return std::nullopt;
  return found[0][0].as<int>();
}

int register_station(pqxx::work& work, const ServerConnection& server, const Digest& identity,
                     const std::string& name, const store::Event& commitment) {
  // Two first stations of two studies come one after the other.
  work.exec("SELECT pg_advisory_xact_lock(hashtextextended('touchtrial ' || current_schema(), 0))");
  refuse_other_study(work, server, commitment);
  return work
      .exec_params1(
          "INSERT INTO stations(station, identity, name) SELECT coalesce(max(station), 0) + 1, $1, "
          "$2 FROM stations RETURNING station",
          binary(identity), name)[0]
      .as<int>();
}

void refuse_other_study(pqxx::work& work, const ServerConnection& server,
                        const store::Event& commitment) {
  const pqxx::result found = work.exec(
      "SELECT body, session FROM events WHERE session < 0 AND sequence = 0 ORDER BY session DESC "
      "LIMIT 1");
  if (found.empty()) return;
  const store::StudyCommitment there = parsed_from(
      found[0][1].as<int>(), found[0][0].as<std::string>(), store::commitment_from_json);
  const auto other = difference(there, store::body_of(commitment, store::commitment_from_json));
  if (!other) return;
  server.refuse("holds " + *other + " (" + one_line(there.study) +
                "); give each its own database (createdb)");
}

store::ChainHead chain_head(pqxx::work& work, int station) {
  const pqxx::result found = work.exec_params(
      "SELECT sequence, hash FROM events WHERE session = $1 ORDER BY sequence DESC LIMIT 1",
      chain_number(station));
  if (found.empty()) return {};
  const Bytes hash = bytes_of(found[0][1]);
  store::ChainHead head{.length = found[0][0].as<std::int64_t>() + 1, .hash = {}};
  if (hash.size() != head.hash.size()) {
    throw store::EventFault(chain_number(station), head.length - 1,
                            "its hash is not 32 bytes long");
  }
  std::copy(hash.begin(), hash.end(), head.hash.begin());
  return head;
}

std::optional<std::int64_t> parting(pqxx::work& work, int station,
                                    std::span<const store::Event> file_chain) {
  const pqxx::result hashes = work.exec_params(
      "SELECT sequence, hash FROM events WHERE session = $1 AND sequence < $2 ORDER BY sequence",
      chain_number(station), file_chain.size());
  for (const pqxx::row& row : hashes) {
    const auto sequence = row[0].as<std::int64_t>();
    const Digest& here = file_chain[static_cast<std::size_t>(sequence)].hash;
    const Bytes there = bytes_of(row[1]);
    if (!std::equal(here.begin(), here.end(), there.begin(), there.end())) return sequence;
  }
  return std::nullopt;
}

void refuse_if_cut_off(pqxx::work& work, const ServerConnection& server,
                       const store::SessionRow& row) {
  const pqxx::result found =
      work.exec_params("SELECT 1 FROM sessions WHERE station = $1 AND own_session = $2",
                       row.station, row.own_session);
  if (found.empty()) return;
  throw store::DamagedStore(
      server.address().shown() + ": the server lost the end of the chain of station " +
      std::to_string(row.station) + ", but has its session " + std::to_string(row.own_session) +
      " still; restore the database from a backup, or make a new one and sync all "
      "stations again");
}

void refuse_if_taken(pqxx::work& work, const ServerConnection& server,
                     const store::SessionRow& row) {
  if (!row.replaced_by.empty()) return;
  const std::optional<Holder> holder = holder_of(work, row);
  if (!holder) return;
  const bool same_person = holder->participant == row.participant;
  const std::string what = same_person ? "participant " + row.participant
                                       : "enrolment number " + std::to_string(row.enrolment);
  server.refuse("session " + std::to_string(row.own_session) + ": " + what +
                " is taken already by session " + std::to_string(holder->own) + " of station " +
                std::to_string(holder->station) + " (" + one_line(holder->station_name) +
                "), participant " + one_line(holder->participant) + ", enrolment " +
                std::to_string(holder->enrolment) + ", " + opening_of(work, holder->session) +
                "; replace one of the two at its station (`touchtrial replace`)" +
                (holder->enrolment == row.enrolment
                     ? ", run nobody under the successor's id, who would inherit the number,"
                     : "") +
                " and sync that first; hand out numbers beforehand (`touchtrial plan --stations`)");
}

bool update_session(pqxx::work& work, int station, int own_session, const SessionCourse& course,
                    std::int64_t end) {
  const auto holds = [&](const std::optional<std::int64_t>& at) { return at && *at < end; };
  work.exec_params0(
      "UPDATE sessions SET excluded = $3, withdrawn = $4, replaced_by = nullif($5, '') "
      "WHERE station = $1 AND own_session = $2",
      station, own_session, int{holds(course.excluded_at)}, int{holds(course.withdrawn_at)},
      holds(course.replaced_at) ? course.replaced_by : std::string());
  if (!holds(course.withdrawn_at)) return false;
  const pqxx::result removed = work.exec_params(
      "DELETE FROM participant_keys WHERE session IN "
      "(SELECT session FROM sessions WHERE station = $1 AND own_session = $2)",
      station, own_session);
  return removed.affected_rows() > 0;
}

std::vector<KeyThere> keys_of_station(pqxx::work& work, int station) {
  std::vector<KeyThere> keys;
  for (const pqxx::row& row :
       work.exec_params("SELECT s.session, s.own_session, coalesce(sha256(k.wrapped), '') FROM "
                        "sessions s LEFT JOIN participant_keys k USING(session) WHERE s.station = "
                        "$1 AND s.withdrawn = 0 AND s.own_session IS NOT NULL ORDER BY s.session",
                        station)) {
    keys.push_back(
        {.session = row[0].as<int>(), .own_session = row[1].as<int>(), .digest = bytes_of(row[2])});
  }
  return keys;
}

}  // namespace touchtrial::collect
