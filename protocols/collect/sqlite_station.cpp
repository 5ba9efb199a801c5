// Stations that are SQLite files, or were collected into one.
#include "protocols/collect/stations.hpp"
#include "protocols/store/collected_chain.hpp"
#include "protocols/store/damage.hpp"
#include "protocols/store/payload_json.hpp"

#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::collect {
namespace {

class SqliteStation final : public StationFile {
 public:
  /// \param station  0: the file is a station's own
  SqliteStation(std::shared_ptr<const store::StudyStore> store, const std::string& file,
                int station)
      : store_(std::move(store)),
        station_(station),
        name_(station == 0 ? file : fmt::format("{}, station {}", file, station)) {
    for (const store::SessionRow& row : store_->sessions()) {
      if (row.station == station) sessions_[row.own_session] = row.session;
    }
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::vector<store::Event> file_chain() override {
    return station_ == 0 ? store_->events(0) : store_->station_chain(station_);
  }
  [[nodiscard]] std::vector<store::Event> events(int own_session) override {
    const auto found = sessions_.find(own_session);
    if (found == sessions_.end()) return {};
    std::vector<store::Event> events = store_->events(found->second);
    for (store::Event& event : events) {
      event.session = event.own_session();
      event.renumbered_from.reset();
    }
    return events;
  }
  [[nodiscard]] store::WrappedKeys wrapped_keys(int own_session) override {
    const auto found = sessions_.find(own_session);
    return found == sessions_.end() ? store::WrappedKeys{} : store_->wrapped_keys(found->second);
  }
  void for_each_trace(int own_session,
                      const std::function<void(int, const Bytes&)>& visit) override {
    for (const store::Event& event : events(own_session)) {
      if (event.kind != store::EventKind::trace_stored) continue;
      const int trial = store::trace_body_from_json(event.body).trial;
      const auto sealed = store_->sealed_trace(sessions_.at(own_session), trial);
      if (sealed) visit(trial, sealed->box);
    }
  }

 private:
  std::shared_ptr<const store::StudyStore> store_;
  int station_;
  std::string name_;
  std::map<int, int> sessions_;  ///< number in the file, by own number
};

/// Refuses a collected file in which something was decided since: collecting again would lose it.
void refuse_own_decisions(const store::StudyStore& store, const std::filesystem::path& database) {
  std::vector<store::StationChain> chains;
  for (int station = 1; station <= store.stations(); ++station) {
    chains.push_back({.name = "", .events = store.station_chain(station)});
  }
  const std::size_t collected = store::collected_chain(chains).events.size();
  const std::vector<store::Event> events = store.events(0);
  if (events.size() == collected) return;
  throw StoreError(one_line(
      fmt::format("{}: was collected from stations, and then '{}' was recorded in it, which no "
                  "other file would have; record that at the station, or after the last merge, "
                  "and merge the stations' own files",
                  database.string(), store::name_of(events[collected].kind))));
}

}  // namespace

Stations stations_of_file(const std::filesystem::path& database, store::TraceCheck traces) {
  const auto store = std::make_shared<const store::StudyStore>(
      store::StudyStore::open(database, store::StudyStore::Access::read_only));
  if (const auto fault = store->first_fault(traces)) {
    throw store::DamagedStore(one_line(fmt::format(
        "{}: {}, event {}: {}; restore it from a backup, or leave it out", database.string(),
        store::chain_named(fault->session), fault->sequence, fault->what)));
  }
  Stations stations;
  const int count = store->stations();
  if (count > 0) refuse_own_decisions(*store, database);
  for (int station = count > 0 ? 1 : 0; station <= count; ++station) {
    stations.push_back(std::make_unique<SqliteStation>(store, database.string(), station));
  }
  return stations;
}

}  // namespace touchtrial::collect
