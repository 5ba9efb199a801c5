#include "protocols/collect/open_study.hpp"

#include "protocols/collect/server_address.hpp"
#include "protocols/collect/server_stations.hpp"

#include <filesystem>

namespace touchtrial::collect {

store::StudyStore open_study(const std::string& where, TraceUse traces) {
  if (!is_address(where))
    return store::StudyStore::open(where, store::StudyStore::Access::read_only);
  const ServerAddress address(where);
  if (traces == TraceUse::fetched) {
    return collected_for_reading(stations_of_server(address), address.shown(), traces);
  }
  // Whoever wants all of it wants to know whether all of it holds.
  DerivedTables derived;
  store::StudyStore collected =
      collected_for_reading(stations_of_server(address, &derived), address.shown(), traces);
  derived(collected);
  return collected;
}

std::string study_name(const std::string& where) {
  if (is_address(where)) return ServerAddress(where).shown();
  return std::filesystem::path(where).filename().string();
}

}  // namespace touchtrial::collect
