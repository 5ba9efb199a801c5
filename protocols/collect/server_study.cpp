#include "protocols/collect/server_study.hpp"

#include "protocols/collect/server_rows.hpp"
#include "protocols/store/damage.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <map>

namespace touchtrial::collect {
namespace {

/// A session that has another's participant id or enrolment number.
struct Holder {
  int session = 0;  ///< on the server
  int own = 0;
  int station = 0;
  std::string station_name;
  std::string participant;
  int enrolment = 0;
};

std::optional<Holder> holder_of(ServerWork& work, const store::SessionRow& row) {
  const pqxx::result found = work.exec(
      "SELECT s.session, coalesce(s.own_session, s.session), s.station, t.name, s.participant, "
      "s.enrolment FROM sessions s JOIN stations t USING(station) WHERE s.replaced_by IS NULL "
      "AND (s.participant = $1 OR s.enrolment = $2) AND s.visit = $3 ORDER BY s.participant <> $1, "
      "s.session LIMIT 1",
      row.participant, row.enrolment, row.visit);
  if (found.empty()) return std::nullopt;
  const pqxx::row& first = found[0];
  return Holder{.session = first[0].as<int>(),
                .own = first[1].as<int>(),
                .station = first[2].as<int>(),
                .station_name = first[3].as<std::string>(),
                .participant = first[4].as<std::string>(),
                .enrolment = first[5].as<int>()};
}

/// `parse(body)` of a chain's first event on the server.
/// \throws EventFault if `parse` throws StoreError
template <typename Parse>
auto parsed_from(int session, const std::string& body, Parse parse) {
  try {
    return parse(body);
  } catch (const StoreError& error) {
    throw store::EventFault(session, 0, error.what());
  }
}

/// "opened 2026-01-05T10:00:00Z on falcon 1234", from the session's first event on the server.
std::string opening_of(ServerWork& work, int session) {
  const pqxx::result found = work.exec(
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

/// What the server holds, in words, if it is not the same study. Stations may differ in the
/// program's version.
std::optional<std::string> difference(const store::StudyCommitment& there,
                                      store::StudyCommitment here) {
  here.program_version = there.program_version;
  here.station = there.station;
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

/// Adds events to a chain.
/// \param refuse  called with the first fault, must throw
template <typename Refuse>
void extend(store::ChainLink& chain, std::span<const store::Event> events, Refuse refuse) {
  for (const store::Event& event : events) {
    try {
      chain.extend(event);
    } catch (const store::EventFault& fault) {
      refuse("event " + std::to_string(event.sequence) + ": " + fault.bare());
    }
  }
}

/// A session that has arrived on the server.
class ArrivedSession {
 public:
  ArrivedSession(const ServerConnection& server, int own_session)
      : server_(server), own_session_(own_session) {}

  [[noreturn]] void refuse(const std::string& why) const {
    server_.refuse("session " + std::to_string(own_session_) + " did not arrive whole: " + why +
                   "; nothing of it was kept, run `touchtrial verify` on the station's file");
  }
  void require(bool holds, const std::string& otherwise) const {
    if (!holds) refuse(otherwise);
  }

  void check_chain(std::span<const store::Event> events, const store::SessionOnFile& course) const {
    store::ChainLink chain(own_session_);
    extend(chain, events, [&](const std::string& why) { refuse(why); });
    require(!events.empty() && events.front().hash == course.opened.first,
            "it begins with another event than the file's chain says");
    require(chain.length() == course.closed->length && chain.head() == course.closed->head,
            "it ends with another event than the file's chain says");
  }

  void check_opening(const store::Event& event, const store::SessionOnFile& course,
                     const store::StudyCommitment& commitment) const {
    const store::SessionOpening opening = store::body_of(event, store::opening_from_json);
    require(opening.study_id == commitment.study_id && opening.seal == commitment.seal,
            "it was recorded under another seal");
    require(opening.participant == course.opened.participant &&
                opening.enrolment == course.opened.enrolment &&
                opening.visit == course.opened.visit,
            "it is another participant's than the file's chain says");
  }

  /// \param digests  that the server computed of what it stored
  void check_traces(std::span<const store::Event> events,
                    const std::map<std::int64_t, SentTrace>& sent,
                    std::map<std::int64_t, Bytes> digests) const {
    for (const store::Event& event : events) {
      if (event.kind != store::EventKind::trace_stored) continue;
      const store::TraceBody body = store::body_of(event, store::trace_body_from_json);
      const auto found = digests.extract(body.trial);
      const auto ours = sent.find(body.trial);
      require(!found.empty() && ours != sent.end() && ours->second.digest == body.trace &&
                  std::ranges::equal(ours->second.sha256, found.mapped()),
              "the trace of trial " + std::to_string(body.trial) + " is not the one recorded");
    }
    require(digests.empty(), "there is a trace without an event");
  }

  void check_keys(const store::WrappedKeys& keys, const store::SessionOnFile& course) const {
    const auto check = [&](const std::optional<Bytes>& key, bool erased, const Digest& digest,
                           const std::string& name) {
      require(key.has_value() != erased, name + " is missing or too many");
      require(!key || sha256(*key) == digest, name + " is another");
    };
    check(keys.participant, course.erased_at.has_value(), course.opened.key,
          "the participant's key");
    check(keys.safety, course.safety_erased_at.has_value(), course.opened.safety_key,
          "the safety key");
  }

  void check_sealed_end(const Bytes& wrapped, const BoxKeys& investigator,
                        std::span<const store::Event> events) const {
    const auto key = store::unwrap_participant_key(investigator, own_session_, wrapped);
    require(key.has_value(), "its key does not open with the study's key");
    const auto secret = store::unsealed(events.back(), *key);
    require(secret.has_value(), "its sealed end does not open");
    const store::ChainEnd end = store::chain_end_from_json(*secret);
    require(end.length == static_cast<std::int64_t>(events.size()) - 1 &&
                end.head == events.back().previous,
            "its sealed end is that of another chain");
  }

 private:
  const ServerConnection& server_;
  int own_session_;
};

/// \throws DamagedStore if this very session is there
void refuse_if_cut_off(ServerWork& work, const ServerConnection& server,
                       const store::SessionRow& row) {
  const pqxx::result found =
      work.exec("SELECT 1 FROM sessions WHERE station = $1 AND own_session = $2", row.station,
                row.own_session);
  if (found.empty()) return;
  throw store::DamagedStore(
      server.address().shown() + ": the server lost the end of the chain of station " +
      std::to_string(row.station) + ", but has its session " + std::to_string(row.own_session) +
      " still; restore the database from a backup, or make a new one and sync all "
      "stations again");
}

/// \throws StoreError if another session has its participant or enrolment number
void refuse_if_taken(ServerWork& work, const ServerConnection& server,
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

}  // namespace

int server_session(const ServerConnection& server, int station, int own_session) {
  constexpr int kMostSessions = 100'000;
  constexpr int kMostStations = 20'000;
  if (own_session < 1 || own_session > kMostSessions || station < 1 || station > kMostStations) {
    server.refuse("has no number for session " + std::to_string(own_session) + " of station " +
                  std::to_string(station) + "; use another database");
  }
  return (station - 1) * kMostSessions + own_session;
}

void lock_station(ServerWork& work, const Digest& identity) {
  work.exec("SELECT touchtrial_lock_station($1)", binary(identity));
}

std::optional<int> find_station(ServerWork& work, const Digest& identity) {
  const pqxx::result found =
      work.exec("SELECT station FROM stations WHERE identity = $1", binary(identity));
  if (found.empty()) return std::nullopt;
  return found[0][0].as<int>();
}

int register_station(ServerWork& work, const ServerConnection& server, const Digest& identity,
                     const std::string& name, const store::Event& commitment) {
  refuse_other_study(work, server, commitment);
  const int station = work.exec1("SELECT touchtrial_next_station()")[0].as<int>();
  const pqxx::result other = work.exec("SELECT name FROM stations WHERE station = $1", station);
  if (!other.empty()) {
    server.refuse("this role is station " + std::to_string(station) + " (" +
                  one_line(other[0][0].as<std::string>()) +
                  "), whose file is another; have the owner admit a role of its own for this file "
                  "(touchtrial_admit)");
  }
  work.exec0("INSERT INTO stations(station, identity, name) VALUES($1, $2, $3)", station,
             binary(identity), name);
  return station;
}

void refuse_other_study(ServerWork& work, const ServerConnection& server,
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

store::ChainHead chain_head(ServerWork& work, int station) {
  const pqxx::result found = work.exec(
      "SELECT sequence, hash FROM events WHERE session = $1 ORDER BY sequence DESC LIMIT 1",
      chain_number(station));
  if (found.empty()) return {};
  const auto last = found[0][0].as<std::int64_t>();
  return {.length = last + 1,
          .hash = store::stored_hash(bytes_of(found[0][1]), chain_number(station), last)};
}

std::optional<std::int64_t> parting(ServerWork& work, int station,
                                    std::span<const store::Event> file_chain) {
  const pqxx::result hashes = work.exec(
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

void refuse_if_there_or_taken(ServerWork& work, const ServerConnection& server,
                              const store::SessionRow& row) {
  refuse_if_cut_off(work, server, row);
  refuse_if_taken(work, server, row);
}

bool destroy_key(ServerWork& work, int session, bool of_safety) {
  return work.exec("SELECT touchtrial_destroy_key($1, $2)", session, of_safety)[0][0].as<int>() > 0;
}

bool update_session(ServerWork& work, int station, int own_session,
                    const store::SessionOnFile& course) {
  const pqxx::result stored = work.exec(
      "UPDATE sessions SET excluded = $3, withdrawn = $4, erased = $5, "
      "replaced_by = nullif($6, '') WHERE station = $1 AND own_session = $2 RETURNING session",
      station, own_session, int{course.excluded_at.has_value()},
      int{course.withdrawn_at.has_value()}, int{course.erased_at.has_value()}, course.replaced_by);
  if (stored.empty()) return false;
  const int session = stored[0][0].as<int>();
  const bool key = course.erased_at && destroy_key(work, session, /*of_safety=*/false);
  const bool safety = course.safety_erased_at && destroy_key(work, session, /*of_safety=*/true);
  return key || safety;
}

std::vector<std::pair<int, int>> sessions_of_station(ServerWork& work, int station) {
  std::vector<std::pair<int, int>> sessions;
  for (const pqxx::row& row :
       work.exec("SELECT session, own_session FROM sessions WHERE station = $1 AND "
                 "own_session IS NOT NULL ORDER BY session",
                 station)) {
    sessions.emplace_back(row[0].as<int>(), row[1].as<int>());
  }
  return sessions;
}

void check_session_arrival(ServerWork& work, const ServerConnection& server, int session,
                           int own_session, const store::SessionOnFile& course,
                           const store::StudyCommitment& commitment,
                           const std::map<std::int64_t, SentTrace>& sent,
                           const std::optional<BoxKeys>& investigator) {
  const ArrivedSession arrived(server, own_session);
  const std::vector<store::Event> events = read_events(work, session);
  arrived.check_chain(events, course);
  arrived.check_opening(events.front(), course, commitment);
  arrived.check_traces(events, sent, trace_digests(work, session));
  const store::WrappedKeys keys = read_keys(work, session);
  arrived.check_keys(keys, course);
  if (investigator && keys.participant) {
    arrived.check_sealed_end(*keys.participant, *investigator, events);
  }
}

void check_chain_arrival(ServerWork& work, const ServerConnection& server, int station,
                         std::span<const store::Event> file_chain, std::int64_t first) {
  const std::vector<store::Event> tail = read_events(work, chain_number(station), first);
  store::ChainLink chain =
      first == 0 ? store::ChainLink(0)
                 : store::ChainLink::after(file_chain[static_cast<std::size_t>(first - 1)]);
  extend(chain, tail, [&](const std::string& why) {
    server.refuse("the file's chain did not arrive whole: " + why + "; nothing of it was kept");
  });
  if (chain.head() != file_chain.back().hash) {
    server.refuse("the file's chain did not arrive whole; nothing of it was kept");
  }
}

}  // namespace touchtrial::collect
