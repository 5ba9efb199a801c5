#include "protocols/collect/server_derived.hpp"

#include "protocols/collect/server_study.hpp"
#include "protocols/store/collected_chain.hpp"
#include "protocols/store/damaged_store.hpp"
#include "protocols/store/row_cells.hpp"
#include "protocols/store/tables.hpp"

#include <initializer_list>
#include <map>
#include <string>
#include <utility>

namespace touchtrial::collect {
namespace {

/// Station on the server, and the session's own number.
using Place = std::pair<int, int>;

store::Cell cell_of(const pqxx::field& field, store::ColumnType type) {
  if (field.is_null()) return {};
  switch (type) {
    case store::ColumnType::integer:
      return field.as<std::int64_t>();
    case store::ColumnType::real:
      return field.as<double>();
    case store::ColumnType::text:
      return field.as<std::string>();
    case store::ColumnType::blob:
      break;  // derived tables have none
  }
  return {};
}

/// \param tables  whose columns the row has, one table after the other
store::Cells cells_of(const pqxx::row& row, std::initializer_list<store::Table> tables) {
  store::Cells cells;
  for (const store::Table table : tables) {
    for (const store::TableColumn& column : store::table_definition(table).columns) {
      cells.push_back(cell_of(row[static_cast<pqxx::row::size_type>(cells.size())], column.type));
    }
  }
  return cells;
}

class DerivedCheck {
 public:
  DerivedCheck(pqxx::work& work, const ServerConnection& server, const store::StudyStore& collected)
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
      responses_ += row.answered_at ? 1 : 0;
    }
  }

  void run() {
    check_sessions();
    check_trials();
    if (work_.exec1("SELECT count(*) FROM responses")[0].as<int>() != responses_) {
      throw store::DamagedStore(
          server_.address().shown() +
          ": table responses holds rows without a trial; restore the database from "
          "a backup");
    }
  }

 private:
  void check_sessions() {
    for (const pqxx::row& row : work_.exec(
             "SELECT " + store::column_list(store::table_definition(store::Table::sessions)) +
             " FROM sessions")) {
      store::SessionRow there = store::session_row(cells_of(row, {store::Table::sessions}));
      const Place place(there.station, there.own_session);
      places_[there.session] = place;
      const auto expected = sessions_.extract(place);
      // Sessions have other numbers there.
      if (!expected.empty()) there.session = expected.mapped().session;
      if (expected.empty() || expected.mapped() != there) refuse("sessions", place);
    }
    if (!sessions_.empty()) refuse("sessions", sessions_.begin()->first);
  }

  void check_trials() {
    for (const pqxx::row& row : work_.exec(
             "SELECT " + store::column_list(store::table_definition(store::Table::trials), "t.") +
             ", " + store::column_list(store::table_definition(store::Table::responses), "r.") +
             " FROM trials t LEFT JOIN responses r USING(session, trial)")) {
      store::TrialRow there =
          store::trial_row(cells_of(row, {store::Table::trials, store::Table::responses}));
      const Place place = places_[there.session];
      const auto expected = trials_.extract({place, there.trial});
      if (!expected.empty()) there.session = expected.mapped().session;
      if (expected.empty() || expected.mapped() != there) refuse("trials or responses", place);
    }
    if (!trials_.empty()) refuse("trials", trials_.begin()->first.first);
  }

  [[noreturn]] void refuse(const std::string& table, const Place& place) const {
    throw store::DamagedStore(server_.address().shown() + ", station " +
                              std::to_string(place.first) + ", session " +
                              std::to_string(place.second) + ": derived table " + table +
                              " disagrees with the events; restore the database from a backup");
  }

  pqxx::work& work_;
  const ServerConnection& server_;
  std::map<int, Place> places_;  ///< by the session's number on the server
  std::map<Place, store::SessionRow> sessions_;
  std::map<std::pair<Place, int>, store::TrialRow> trials_;
  int responses_ = 0;
};

}  // namespace

void check_derived(pqxx::work& work, const ServerConnection& server,
                   const store::StudyStore& collected) {
  DerivedCheck(work, server, collected).run();
}

}  // namespace touchtrial::collect
