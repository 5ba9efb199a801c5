#include "protocols/collect/server_derived.hpp"

#include "protocols/collect/server_study.hpp"
#include "protocols/store/collected_chain.hpp"
#include "protocols/store/damaged_store.hpp"
#include "protocols/store/state_names.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::collect {
namespace {

/// Station on the server, and the session's own number.
using Place = std::pair<int, int>;

/// One row of a derived table as text, in the order of its columns.
std::string text_of(const store::SessionRow& row) {
  return row.participant + "|" + std::to_string(row.enrolment) + "|" +
         std::string(store::name_of(row.state)) + "|" + std::to_string(row.simulated) + "|" +
         std::to_string(row.pilot) + "|" + std::to_string(row.excluded) + "|" +
         std::to_string(row.withdrawn) + "|" + row.device + "|" + row.replaced_by;
}

template <typename Value>
std::string text_of(const std::optional<Value>& value) {
  return value ? std::to_string(*value) : "";
}

std::string text_of(const store::TrialRow& row) {
  const auto time = [](const std::optional<std::chrono::nanoseconds>& at) {
    return at ? std::to_string(at->count()) : std::string();
  };
  return std::to_string(row.block) + "|" + std::string(store::name_of(row.state)) + "|" +
         time(row.presented_at) + "|" + time(row.contact_at) + "|" + std::to_string(row.valid) +
         "|" + std::to_string(row.overruns) + "|" + std::to_string(row.samples) + "|" +
         std::to_string(row.explorations) + "|" + time(row.answered_at) + "|" +
         text_of(row.position) + "|" + text_of(row.first_position) + "|" + text_of(row.confidence);
}

/// The same in SQL; rates, which have no such simple text, come as numbers.
constexpr const char* kSessionRows =
    "SELECT station, coalesce(own_session, session), concat_ws('|', participant, enrolment, state, "
    "simulated, pilot, excluded, withdrawn, device, coalesce(replaced_by, '')) FROM sessions";
constexpr const char* kTrialRows =
    "SELECT s.station, coalesce(s.own_session, s.session), t.trial, t.rate_hz, concat(t.block, "
    "'|', t.state, '|', t.presented_at_ns, '|', t.contact_at_ns, '|', t.valid, '|', t.overruns, "
    "'|', t.samples, '|', t.explorations, '|', r.answered_at_ns, '|', r.position, '|', "
    "r.first_position, '|', r.confidence) FROM trials t LEFT JOIN sessions s USING(session) "
    "LEFT JOIN responses r ON r.session = t.session AND r.trial = t.trial";

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
    for (const store::SessionRow& row : collected.sessions()) {
      places_[row.session] = {stations[row.station], row.own_session};
      sessions_[places_[row.session]] = text_of(row);
    }
    for (const store::TrialRow& row : collected.trials()) {
      trials_[{places_[row.session], row.trial}] = {row.rate_hz, text_of(row)};
      responses_ += row.answered_at ? 1 : 0;
    }
  }

  void run() {
    for (const pqxx::row& row : work_.exec(kSessionRows)) {
      const Place place(row[0].as<int>(), row[1].as<int>());
      const auto expected = sessions_.extract(place);
      if (expected.empty() || expected.mapped() != row[2].c_str()) refuse("sessions", place);
    }
    if (!sessions_.empty()) refuse("sessions", sessions_.begin()->first);
    for (const pqxx::row& row : work_.exec(kTrialRows)) {
      const Place place(row[0].as<int>(0), row[1].as<int>(0));
      const auto expected = trials_.extract({place, row[2].as<int>()});
      const bool same = !expected.empty() && expected.mapped().first == row[3].as<double>() &&
                        expected.mapped().second == row[4].c_str();
      if (!same) refuse("trials or responses", place);
    }
    if (!trials_.empty()) refuse("trials", trials_.begin()->first.first);
    if (work_.exec1("SELECT count(*) FROM responses")[0].as<int>() != responses_) {
      throw store::DamagedStore(
          server_.address().shown() +
          ": table responses holds rows without a trial; restore the database from "
          "a backup");
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& table, const Place& place) const {
    throw store::DamagedStore(server_.address().shown() + ", station " +
                              std::to_string(place.first) + ", session " +
                              std::to_string(place.second) + ": derived table " + table +
                              " disagrees with the events; restore the database from a backup");
  }

  pqxx::work& work_;
  const ServerConnection& server_;
  std::map<int, Place> places_;
  std::map<Place, std::string> sessions_;
  std::map<std::pair<Place, int>, std::pair<double, std::string>> trials_;
  int responses_ = 0;
};

}  // namespace

void check_derived(pqxx::work& work, const ServerConnection& server,
                   const store::StudyStore& collected) {
  DerivedCheck(work, server, collected).run();
}

}  // namespace touchtrial::collect
