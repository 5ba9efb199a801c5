// Stations that are kept on a server.
#include "protocols/collect/server_rows.hpp"
#include "protocols/collect/server_schema.hpp"
#include "protocols/collect/server_study.hpp"
#include "protocols/collect/server_tables.hpp"
#include "protocols/collect/stations.hpp"
#include "protocols/store/collected_chain.hpp"
#include "protocols/store/damage.hpp"

#include <initializer_list>
#include <map>
#include <memory>
#include <utility>

namespace touchtrial::collect {
namespace {

/// A connection, and a transaction that sees one moment.
class Snapshot {
 public:
  explicit Snapshot(const ServerAddress& address) : server_(address) {
    require_current(server_);
    look_ = server_.translated([&] { return server_.begin_look(); });
  }

  template <typename Work>
  decltype(auto) ask(Work&& work) {
    return server_.translated([&] { return work(*look_); });
  }
  void call(int session, const std::string& place) { server_.call(session, place); }
  [[nodiscard]] const ServerConnection& server() const noexcept { return server_; }

 private:
  ServerConnection server_;
  std::unique_ptr<ServerWork> look_;  // destroyed before the connection
};

class ServerStation final : public StationFile {
 public:
  ServerStation(std::shared_ptr<Snapshot> snapshot, int station, const std::string& name)
      : snapshot_(std::move(snapshot)),
        station_(station),
        name_(snapshot_->server().address().shown() + ", station " + std::to_string(station) +
              " (" + one_line(name) + ")") {}

  void add_session(int own_session, int session) { sessions_[own_session] = session; }

  const std::string& name() const override { return name_; }

  std::vector<store::Event> file_chain() override {
    return snapshot_->ask(
        [&](ServerWork& work) { return read_events(work, chain_number(station_)); });
  }

  std::vector<store::Event> events(int own_session) override {
    return ask_about(own_session,
                     [](ServerWork& work, int session) { return read_events(work, session); });
  }

  store::WrappedKeys wrapped_keys(int own_session) override {
    return ask_about(own_session, read_keys);
  }

  std::optional<Bytes> trace(int own_session, int trial) override {
    return ask_about(own_session, [&](ServerWork& work, int session) {
      return read_trace(work, session, trial);
    });
  }

  void for_each_trace(int own_session,
                      const std::function<void(int, const Bytes&)>& visit) override {
    for (const TrialRange& batch : ask_about(own_session, trace_batches)) {
      const auto traces = ask_about(own_session, [&](ServerWork& work, int session) {
        return read_traces(work, session, batch);
      });
      // Outside `ask`: errors of `visit` are not the server's.
      for (const auto& [trial, box] : traces) visit(trial, box);
    }
  }

 private:
  /// What `read` gets for a session by its number on the server; nothing if there is none.
  template <typename Read>
  auto ask_about(int own_session, Read read)
      -> decltype(read(std::declval<ServerWork&>(), own_session)) {
    const auto found = sessions_.find(own_session);
    if (found == sessions_.end()) return {};
    return snapshot_->ask([&](ServerWork& work) { return read(work, found->second); });
  }

  std::shared_ptr<Snapshot> snapshot_;
  int station_;
  std::string name_;
  std::map<int, int> sessions_;  ///< number on the server, by own number
};

/// Refuses rows that belong to nothing that was pushed. No other check would find them.
void refuse_strays(ServerWork& work, const ServerConnection& server) {
  for (const char* const table : {"events", "traces", "participant_keys", "safety_keys"}) {
    const pqxx::result strays = work.exec(
        "SELECT e.session FROM (SELECT DISTINCT session FROM " + std::string(table) +
        ") e LEFT JOIN sessions s USING(session) LEFT JOIN stations t ON t.station = -e.session "
        "WHERE s.session IS NULL AND t.station IS NULL LIMIT 1");
    if (strays.empty()) continue;
    throw store::DamagedStore(server.address().shown() + ": table " + table +
                              " holds rows of session " + strays[0][0].as<std::string>() +
                              ", which no station has; restore the database from a backup");
  }
}

std::map<int, std::unique_ptr<ServerStation>> named_stations(
    ServerWork& work, const std::shared_ptr<Snapshot>& snapshot) {
  std::map<int, std::unique_ptr<ServerStation>> stations;
  std::map<int, std::string> places;
  // Rows of stations without a chain and sessions are left out: any station's role can write them.
  for (const pqxx::row& row :
       work.exec("SELECT station, name FROM stations t WHERE EXISTS (SELECT FROM events WHERE "
                 "session = -t.station) OR EXISTS (SELECT FROM sessions s WHERE s.station = "
                 "t.station) ORDER BY station")) {
    const int station = row[0].as<int>();
    const std::string name =
        "station " + row[0].as<std::string>() + " (" + one_line(row[1].as<std::string>()) + ")";
    places[station] = name;
    snapshot->call(chain_number(station), name + ", file chain");
    stations[station] =
        std::make_unique<ServerStation>(snapshot, station, row[1].as<std::string>());
  }
  for (const pqxx::row& row :
       work.exec("SELECT station, coalesce(own_session, session), session FROM sessions")) {
    const auto found = stations.find(row[0].as<int>());
    if (found == stations.end()) continue;
    found->second->add_session(row[1].as<int>(), row[2].as<int>());
    snapshot->call(row[2].as<int>(),
                   places[found->first] + ", session " + row[1].as<std::string>());
  }
  return stations;
}

/// The station's number on the server, and the session's own number.
using Place = std::pair<int, int>;

/// \param table  whose columns the row has
Cells row_cells(const pqxx::row& row, Table table) {
  return cells_of(table, [&](int column, ColumnType type) -> Cell {
    const pqxx::field field = row[static_cast<pqxx::row::size_type>(column)];
    if (field.is_null()) return {};
    if (type == ColumnType::integer) return field.as<std::int64_t>();
    if (type == ColumnType::real) return field.as<double>();
    return field.as<std::string>();  // derived tables have no blobs
  });
}

/// Holds the derived tables on a server against a study that was collected from its events.
class DerivedCheck {
 public:
  DerivedCheck(ServerWork& work, const ServerConnection& server, const store::StudyStore& collected)
      : work_(work), server_(server) {
    std::map<int, int> stations;  // on the server, by the number in the collected study
    for (int station = 1; station <= collected.stations(); ++station) {
      const auto identity = store::station_identity(collected.station_chain(station));
      const auto number = identity ? find_station(work, *identity) : std::nullopt;
      if (number) stations[station] = *number;
    }
    std::map<int, Place> places;
    for (store::SessionRow row : collected.sessions()) {
      const Place place(stations[row.station], row.own_session);
      places[row.session] = place;
      row.station = place.first;
      sessions_[place] = row;
    }
    for (const store::TrialRow& row : collected.trials()) {
      trials_[{places[row.session], row.trial}] = row;
    }
  }

  /// \throws DamagedStore naming station and session of the first row that disagrees
  void run() {
    check_sessions();
    check_trials();
  }

 private:
  void check_sessions() {
    for (const pqxx::row& row :
         work_.exec("SELECT " + column_list(Table::sessions) + " FROM sessions")) {
      store::SessionRow there = session_row(row_cells(row, Table::sessions));
      const Place place(there.station, there.own_session);
      places_[there.session] = place;
      const auto expected = sessions_.extract(place);
      // Sessions have other numbers on the server.
      if (!expected.empty()) there.session = expected.mapped().session;
      if (expected.empty() || expected.mapped() != there) refuse("sessions", place);
    }
    if (!sessions_.empty()) refuse("sessions", sessions_.begin()->first);
  }

  void check_trials() {
    for (const pqxx::row& row :
         work_.exec("SELECT " + column_list(Table::trials) + " FROM trials")) {
      store::TrialRow there = trial_row(row_cells(row, Table::trials));
      const Place place = places_[there.session];
      const auto expected = trials_.extract({place, there.trial});
      if (!expected.empty()) there.session = expected.mapped().session;
      if (expected.empty() || expected.mapped() != there) refuse("trials", place);
    }
    if (!trials_.empty()) refuse("trials", trials_.begin()->first.first);
  }

  [[noreturn]] void refuse(const std::string& table, const Place& place) const {
    throw store::DamagedStore(server_.address().shown() + ", station " +
                              std::to_string(place.first) + ", session " +
                              std::to_string(place.second) + ": derived table " + table +
                              " disagrees with the events; restore the database from a backup");
  }

  ServerWork& work_;
  const ServerConnection& server_;
  std::map<int, Place> places_;  ///< by the session's number on the server
  std::map<Place, store::SessionRow> sessions_;
  std::map<std::pair<Place, int>, store::TrialRow> trials_;
};

}  // namespace

Stations stations_of_server(const ServerAddress& address, DerivedTables* derived) {
  const auto snapshot = std::make_shared<Snapshot>(address);
  if (derived != nullptr) {
    *derived = [snapshot](const store::StudyStore& collected) {
      snapshot->ask(
          [&](ServerWork& work) { DerivedCheck(work, snapshot->server(), collected).run(); });
    };
  }
  return snapshot->ask([&](ServerWork& work) {
    refuse_strays(work, snapshot->server());
    Stations stations;
    for (auto& [number, station] : named_stations(work, snapshot)) {
      stations.push_back(std::move(station));
    }
    if (stations.empty()) {
      snapshot->server().refuse("holds no study yet; push one with `touchtrial sync`");
    }
    return stations;
  });
}

}  // namespace touchtrial::collect
