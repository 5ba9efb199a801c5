// Stations whose data are in an SQLite file: the station's own, or a collected one.
#include "record/collected_chain.hpp"
#include "record/damage.hpp"
#include "record/merging/stations.hpp"
#include "record/payload_json.hpp"

#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::merging {
namespace {

class SqliteStation final : public StationFile {
 public:
  /// \param station  number in a collected file; 0: the file is the station's own
  SqliteStation(std::shared_ptr<const record::StudyStore> store, const std::string& file,
                int station)
      : store_(std::move(store)),
        station_(station),
        name_(station == 0 ? file : fmt::format("{}, station {}", file, station)) {
    for (const record::SessionRow& row : store_->sessions()) {
      if (row.station == station) sessions_[row.own_session] = row.session;
    }
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::vector<record::Event> file_chain() override {
    return station_ == 0 ? store_->events(0) : store_->station_chain(station_);
  }
  [[nodiscard]] std::vector<record::Event> events(int own_session) override {
    const auto found = sessions_.find(own_session);
    if (found == sessions_.end()) return {};
    std::vector<record::Event> events = store_->events(found->second);
    for (record::Event& event : events) {
      event.session = event.own_session();
      event.renumbered_from.reset();
    }
    return events;
  }
  [[nodiscard]] record::WrappedKeys wrapped_keys(int own_session) override {
    const auto found = sessions_.find(own_session);
    return found == sessions_.end() ? record::WrappedKeys{} : store_->wrapped_keys(found->second);
  }
  void for_each_trace(int own_session,
                      const std::function<void(int, const Bytes&)>& visit) override {
    for (const record::Event& event : events(own_session)) {
      if (event.kind != record::EventKind::trace_stored) continue;
      const int trial = record::from_json<record::TraceBody>(event.body).trial;
      const auto sealed = store_->sealed_trace(sessions_.at(own_session), trial);
      if (sealed) visit(trial, sealed->box);
    }
  }

 private:
  std::shared_ptr<const record::StudyStore> store_;
  int station_;
  std::string name_;
  std::map<int, int> sessions_;  ///< numbers in the file, by number at the station
};

/// Refuses a collected file with later decisions: collecting again would lose them.
void refuse_later_decisions(const record::StudyStore& store,
                            const std::filesystem::path& database) {
  std::vector<record::StationChain> chains;
  for (int station = 1; station <= store.stations(); ++station) {
    chains.push_back({.name = "", .events = store.station_chain(station)});
  }
  const std::size_t collected = record::collected_chain(chains).events.size();
  const std::vector<record::Event> events = store.events(0);
  if (events.size() == collected) return;
  throw StoreError(one_line(
      fmt::format("{}: was collected from stations, and then '{}' was recorded in it, which would "
                  "be lost; record that at the station, or after the last merge, and merge the "
                  "stations' own files",
                  database.string(), record::name_of(events[collected].kind))));
}

}  // namespace

Stations stations_of_file(const std::filesystem::path& database, record::TraceCheck traces) {
  const auto store = std::make_shared<const record::StudyStore>(
      record::StudyStore::open(database, record::StudyStore::Access::read_only));
  if (const auto fault = store->first_fault(traces)) {
    throw record::DamagedStore(one_line(fmt::format(
        "{}: {}, event {}: {}; restore it from a backup, or leave it out", database.string(),
        record::chain_name(fault->session), fault->sequence, fault->what)));
  }
  Stations stations;
  const int count = store->stations();
  if (count > 0) refuse_later_decisions(*store, database);
  for (int station = count > 0 ? 1 : 0; station <= count; ++station) {
    stations.push_back(std::make_unique<SqliteStation>(store, database.string(), station));
  }
  return stations;
}

}  // namespace touchtrial::merging
