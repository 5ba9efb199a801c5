#include "app/sync_summary.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

using nlohmann::json;

json sessions_json(const std::vector<collect::PushedSession>& sessions) {
  json list = json::array();
  for (const collect::PushedSession& session : sessions) {
    list.push_back({{"session", session.session},
                    {"participant", session.participant},
                    {"enrolment", session.enrolment}});
  }
  return list;
}

json station_json(const StationSummary& summary) {
  const collect::PushReport& report = summary.report;
  return {{"file", summary.file},
          {"station", report.station},
          {"pushed", sessions_json(report.pushed)},
          {"already_there", report.already_there},
          {"left_open", sessions_json(report.left_open)},
          {"cut_short", sessions_json(report.cut_short)},
          {"chain_events", report.chain_events},
          {"ahead", report.ahead},
          {"keys_restored", report.keys_restored},
          {"reconnections", report.reconnections}};
}

json balance_json(const collect::EnrolmentBalance& balance) {
  json stations = json::object();
  for (const auto& [station, count] : balance.stations) stations[std::to_string(station)] = count;
  return {{"stations", stations},       {"method_rows", balance.rows},
          {"gaps", balance.gaps},       {"gap_count", balance.gap_count},
          {"highest", balance.highest}, {"imbalances", collect::imbalances(balance)}};
}

}  // namespace

std::string sync_json(const SyncSummary& summary) {
  json stations = json::array();
  for (const StationSummary& station : summary.stations) stations.push_back(station_json(station));
  const json object = {
      {"server", summary.server},
      {"dry_run", summary.dry_run},
      {"stations", stations},
      {"balance", summary.balance_unknown.empty() ? balance_json(summary.balance)
                                                  : json{{"unknown", summary.balance_unknown}}}};
  return object.dump(2) + "\n";
}

}  // namespace touchtrial::app
