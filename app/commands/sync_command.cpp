// sync: sends a station's finished sessions to a PostgreSQL database.
#include "app/commands/commands.hpp"
#include "app/commands/heads.hpp"
#include "app/terminal/console.hpp"
#include "core/text.hpp"
#include "record/merging/bundle_table.hpp"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

using nlohmann::json;

struct SyncArguments {
  std::filesystem::path database;
  std::string server;
  bool dry_run = false;
  bool json = false;
};

std::string text_of_report(const std::string& file, const merging::SendReport& report,
                           bool dry_run) {
  std::string text = fmt::format("{}: {} {}, {} already there\n", file,
                                 counted(std::ssize(report.sent), "session"),
                                 dry_run ? "to send" : "sent", report.already_there);
  if (report.rows_with_erased_keys.empty()) return text;
  return text + fmt::format(
                    "{}: the server still contains keys of participants who withdrew; the table's "
                    "owner destroys them with DELETE FROM touchtrial_bundles WHERE bundle IN ({}); "
                    "VACUUM FULL touchtrial_bundles; and its backups and WAL archives\n",
                    file, fmt::join(report.rows_with_erased_keys, ", "));
}

int sync(const SyncArguments& arguments) {
  check_against_heads(arguments.database);
  const merging::Stations stations =
      merging::stations_of_file(arguments.database, record::TraceCheck::full);
  const auto table = merging::open_bundle_table(arguments.server);
  json reports = json::array();
  std::string text =
      table->address() + (arguments.dry_run ? " (dry run: nothing was changed)\n" : "\n");
  for (const auto& station : stations) {
    const merging::SendReport report =
        merging::send_station(*station, *table, arguments.dry_run, progress_bar("send"));
    json left_out = json::array();
    for (const merging::SessionLeftOut& session : report.left_out) {
      spdlog::warn("{}", session.words());
      left_out.push_back(session.participant);
    }
    text += text_of_report(station->name(), report, arguments.dry_run);
    reports.push_back({{"file", station->name()},
                       {"sent", report.sent},
                       {"already_there", report.already_there},
                       {"left_out", left_out},
                       {"rows_with_erased_keys", report.rows_with_erased_keys}});
  }
  const json summary = {
      {"server", table->address()}, {"dry_run", arguments.dry_run}, {"stations", reports}};
  print(arguments.json ? json_text(summary) : text);
  return 0;
}

}  // namespace

void add_sync_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "sync", "Send finished sessions to a PostgreSQL database", sync);
  add_database_argument(command, arguments.database, "Database of the station");
  const std::string meaning = "postgresql://USER@HOST/DATABASE; ~/.pgpass contains the password";
  command.add_option("SERVER", arguments.server, meaning)->required();
  command.add_flag("--dry-run", arguments.dry_run,
                   "Show what would be sent, without changing anything");
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
