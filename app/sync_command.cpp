// sync: pushes a station's finished sessions into a PostgreSQL database.
#include "analysis/text_figures.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "protocols/collect/collect.hpp"
#include "protocols/collect/enrolment_balance.hpp"
#include "protocols/collect/server_address.hpp"
#include "protocols/collect/station_push.hpp"
#include "protocols/store/damage.hpp"
#include "protocols/store/study_store.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct StationSummary {
  std::string file;
  collect::PushReport report;
};

struct SyncSummary {
  std::string server;  ///< without the user
  bool dry_run = false;
  std::vector<StationSummary> stations{};
  collect::EnrolmentBalance balance{};  ///< of all sessions on the server
  std::string balance_unknown{};        ///< why the balance is unknown; empty if it is known
};

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
          {"keys_destroyed", report.keys_destroyed},
          {"keys_wiped", report.keys_wiped},
          {"keys_restored", report.keys_restored},
          {"reconnections", report.reconnections}};
}

json balance_json(const collect::EnrolmentBalance& balance) {
  json stations = json::object();
  for (const auto& [station, count] : balance.stations) stations[std::to_string(station)] = count;
  return {{"stations", stations},
          {"gaps", balance.gaps},
          {"gap_count", balance.gap_count},
          {"highest", balance.highest},
          {"imbalances", collect::imbalances(balance)}};
}

std::string sync_json(const SyncSummary& summary) {
  json stations = json::array();
  for (const StationSummary& station : summary.stations) stations.push_back(station_json(station));
  const json object = {
      {"server", summary.server},
      {"dry_run", summary.dry_run},
      {"stations", stations},
      {"balance", summary.balance_unknown.empty() ? balance_json(summary.balance)
                                                  : json{{"unknown", summary.balance_unknown}}}};
  return json_text(object);
}

std::string participants(const std::vector<collect::PushedSession>& sessions) {
  return listed(sessions, ", ", &collect::PushedSession::participant);
}

std::string counted(const std::vector<collect::PushedSession>& sessions) {
  return analysis::counted(static_cast<std::int64_t>(sessions.size()), "session");
}

std::string station_text(const StationSummary& summary, bool dry_run) {
  const collect::PushReport& report = summary.report;
  std::string text = fmt::format("{}: {} {}, {} there before", summary.file, counted(report.pushed),
                                 dry_run ? "to push" : "pushed", report.already_there);
  if (report.station > 0) text += fmt::format(" (station {})", report.station);
  text += "\n";
  if (!report.left_open.empty()) {
    text += fmt::format("{}: {} not finished and left for later: {}\n", summary.file,
                        counted(report.left_open), participants(report.left_open));
  }
  if (!report.cut_short.empty()) {
    text += fmt::format(
        "{}: {} replaced or withdrawn before the end; {} not pushed and cannot be continued: {}\n",
        summary.file, counted(report.cut_short),
        report.cut_short.size() == 1 ? "it was" : "they were", participants(report.cut_short));
  }
  if (report.ahead > 0) {
    text += fmt::format(
        "{}: is an older copy: the server has {} more events of its file chain; do not record in "
        "it any more\n",
        summary.file, report.ahead);
  }
  if (report.keys_destroyed > 0) {
    text += fmt::format(
        "{}: destroyed {} key{} of participants who withdrew{}; destroy the server's backups and "
        "WAL "
        "archives from before too\n",
        summary.file, report.keys_destroyed, report.keys_destroyed == 1 ? "" : "s",
        report.keys_wiped
            ? ""
            : ", whose bytes stay in the table's file until the owner runs VACUUM FULL "
              "participant_keys");
  }
  if (report.keys_restored > 0) {
    text +=
        fmt::format("{}: restored {} key{} that somebody had deleted or changed on the server\n",
                    summary.file, report.keys_restored, report.keys_restored == 1 ? "" : "s");
  }
  if (report.reconnections > 0) {
    text += fmt::format("{}: lost the connection; {} attempt{} to reconnect\n", summary.file,
                        report.reconnections, report.reconnections == 1 ? "" : "s");
  }
  return text;
}

std::string sync_text(const SyncSummary& summary) {
  std::string text =
      summary.server + (summary.dry_run ? " (dry run: nothing was changed)\n" : "\n");
  for (const StationSummary& station : summary.stations) {
    text += station_text(station, summary.dry_run);
  }
  if (!summary.balance_unknown.empty()) {
    return text + "balance: unknown (" + summary.balance_unknown + ")\n";
  }
  for (const std::string& line : collect::imbalances(summary.balance))
    text += "imbalance: " + line + "\n";
  return text;
}

struct SyncArguments {
  fs::path database;
  fs::path key;
  std::string to;
  bool dry_run = false;
  bool json = false;
};

/// Refuses to push a database whose chains do not hold.
void verify(const store::StudyStore& store, const fs::path& database) {
  const std::optional<store::ChainFault> fault = store.first_fault();
  if (!fault) return;
  const std::string place = fault->session == 0 ? std::string("the file's chain")
                                                : "session " + std::to_string(fault->session);
  throw VerificationError(one_line(database.string() + ": " + place + ", event " +
                                   std::to_string(fault->sequence) + ": " + fault->what) +
                          "; nothing was pushed; restore the file from a backup");
}

/// The key that is named, or the one beside the database if it exists.
std::optional<design::StudyKey> key_for(const store::StudyStore& store,
                                        const SyncArguments& arguments) {
  if (arguments.key.empty() && !is_there(key_path_for(arguments.database, {}))) return std::nullopt;
  return key_of_database(store, arguments.database, arguments.key);
}

/// Sets the summary's balance. A connection that is lost now must not hide that everything has been
/// pushed.
/// \throws DamagedStore if the server's data are damaged
void ask_balance(const collect::ServerAddress& server, SyncSummary& summary) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      summary.balance = collect::enrolment_balance(collect::sessions_on_server(server));
      summary.balance_unknown.clear();
      return;
    } catch (const store::DamagedStore&) {
      throw;
    } catch (const StoreError& error) {
      summary.balance_unknown = error.what();
    }
  }
}

int sync(const SyncArguments& arguments) {
  const collect::ServerAddress server(arguments.to);
  collect::PushOptions options{.dry_run = arguments.dry_run, .progress = progress_bar("push")};
  {
    const store::StudyStore store =
        store::StudyStore::open(arguments.database, store::StudyStore::Access::read_only);
    verify(store, arguments.database);
    if (const std::optional<design::StudyKey> key = key_for(store, arguments))
      options.investigator = key->box();
  }
  SyncSummary summary{.server = server.shown(), .dry_run = arguments.dry_run};
  for (const auto& station : collect::stations_of_file(arguments.database)) {
    collect::PushReport report;
    collect::push_station(*station, server, options, report);
    summary.stations.push_back({station->name(), report});
  }
  const auto print_summary = [&] {
    print(arguments.json ? sync_json(summary) : sync_text(summary));
  };
  try {
    ask_balance(server, summary);
  } catch (const store::DamagedStore& error) {
    summary.balance_unknown = error.what();
    print_summary();  // the sessions have been pushed
    throw;
  }
  print_summary();
  return 0;
}

}  // namespace

void add_sync_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<SyncArguments>();
  CLI::App* command =
      program.add_subcommand("sync", "Push finished sessions into a PostgreSQL database");
  add_database_argument(*command, arguments->database, "Database of the station");
  command
      ->add_option("--to", arguments->to,
                   "postgresql://USER@HOST/DATABASE, without a password, which comes from "
                   "~/.pgpass, PGPASSWORD or a service file")
      ->required();
  add_key_option(*command, arguments->key,
                 "Key of the study, to open the sealed ends of sessions (default: DB.key, if it "
                 "exists)");
  command->add_flag("--dry-run", arguments->dry_run,
                    "Show what would be pushed, and change nothing");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return sync(*arguments); }; });
}

}  // namespace touchtrial::app
