#include "protocols/collect/server_stations.hpp"

#include "protocols/collect/server_connection.hpp"
#include "protocols/collect/server_derived.hpp"
#include "protocols/collect/server_rows.hpp"
#include "protocols/collect/server_schema.hpp"
#include "protocols/collect/server_study.hpp"
#include "protocols/store/damaged_store.hpp"

#include <map>
#include <memory>
#include <utility>

namespace touchtrial::collect {
namespace {

/// A connection and the moment that it looks at.
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
  std::unique_ptr<pqxx::work> look_;  // must go before the connection
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
        [&](pqxx::work& work) { return read_events(work, chain_number(station_)); });
  }

  std::vector<store::Event> events(int own_session) override {
    const std::optional<int> session = number_of(own_session);
    if (!session) return {};
    return snapshot_->ask([&](pqxx::work& work) { return read_events(work, *session); });
  }

  std::optional<Bytes> wrapped_key(int own_session) override {
    const std::optional<int> session = number_of(own_session);
    if (!session) return std::nullopt;
    return snapshot_->ask([&](pqxx::work& work) { return read_key(work, *session); });
  }

  std::optional<Bytes> trace(int own_session, int trial) override {
    const std::optional<int> session = number_of(own_session);
    if (!session) return std::nullopt;
    return snapshot_->ask([&](pqxx::work& work) { return read_trace(work, *session, trial); });
  }

  void for_each_trace(int own_session,
                      const std::function<void(int, const Bytes&)>& visit) override {
    const std::optional<int> session = number_of(own_session);
    if (!session) return;
    const std::vector<TrialRange> batches =
        snapshot_->ask([&](pqxx::work& work) { return trace_batches(work, *session); });
    for (const TrialRange& batch : batches) {
      const auto traces =
          snapshot_->ask([&](pqxx::work& work) { return read_traces(work, *session, batch); });
      // Its complaints are not the server's.
      for (const auto& [trial, box] : traces) visit(trial, box);
    }
  }

 private:
  [[nodiscard]] std::optional<int> number_of(int own_session) const {
    const auto found = sessions_.find(own_session);
    if (found == sessions_.end()) return std::nullopt;
    return found->second;
  }

  std::shared_ptr<Snapshot> snapshot_;
  int station_;
  std::string name_;
  std::map<int, int> sessions_;  ///< by own number: that on the server
};

/// Whatever was laid beside what was pushed would otherwise not be seen by anybody.
void refuse_strays(pqxx::work& work, const ServerConnection& server) {
  for (const char* const table : {"events", "traces", "participant_keys"}) {
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
    pqxx::work& work, const std::shared_ptr<Snapshot>& snapshot) {
  std::map<int, std::unique_ptr<ServerStation>> stations;
  std::map<int, std::string> places;
  // A row without a chain and without sessions is nobody's: any station's role can write one.
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

}  // namespace

Stations stations_of_server(const ServerAddress& address, DerivedTables* derived) {
  const auto snapshot = std::make_shared<Snapshot>(address);
  if (derived != nullptr) {
    *derived = [snapshot](const store::StudyStore& collected) {
      snapshot->ask([&](pqxx::work& work) { check_derived(work, snapshot->server(), collected); });
    };
  }
  return snapshot->ask([&](pqxx::work& work) {
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
