// sync: a station's finished sessions, into a PostgreSQL database.
#include "analysis/collection.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/key_of_database.hpp"
#include "app/sync_summary.hpp"
#include "core/errors.hpp"
#include "protocols/collect/collect.hpp"
#include "protocols/collect/server_address.hpp"
#include "protocols/collect/station_push.hpp"
#include "protocols/store/damaged_store.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct SyncArguments {
  fs::path database;
  fs::path key;
  std::string to;
  bool dry_run = false;
  bool json = false;
};

/// What does not hold here must not be passed on.
void verify(const store::StudyStore& store, const fs::path& database) {
  const std::optional<store::ChainFault> fault = store.first_fault();
  if (!fault) return;
  const std::string place = fault->session == 0 ? std::string("the file's chain")
                                                : "session " + std::to_string(fault->session);
  throw VerificationError(one_line(database.string() + ": " + place + ", event " +
                                   std::to_string(fault->sequence) + ": " + fault->what) +
                          "; nothing was pushed, restore the file from a backup");
}

/// The key that is named, or the one beside the database if it is there.
std::optional<design::StudyKey> key_for(const store::StudyStore& store,
                                        const SyncArguments& arguments) {
  std::error_code error;
  const bool is_there = fs::exists(key_path_for(arguments.database, arguments.key), error);
  if (arguments.key.empty() && !is_there) return std::nullopt;
  return key_of_database(store, arguments.database, arguments.key);
}

/// All is pushed when this is asked: a connection that is lost now must not hide that.
/// \throws DamagedStore if what is there cannot be believed
void ask_balance(const collect::ServerAddress& server, int method_orders, SyncSummary& summary) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      summary.balance =
          collect::enrolment_balance(collect::sessions_on_server(server), method_orders);
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
  int method_orders = 1;
  {
    const store::StudyStore store =
        store::StudyStore::open(arguments.database, store::StudyStore::Access::read_only);
    verify(store, arguments.database);
    if (const std::optional<design::StudyKey> key = key_for(store, arguments))
      options.master = key->master;
    method_orders =
        analysis::prescription_from_json(store.commitment().configuration).method_orders;
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
    ask_balance(server, method_orders, summary);
  } catch (const store::DamagedStore& error) {
    summary.balance_unknown = error.what();
    print_summary();  // what was pushed is there
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
  command->add_option("DB", arguments->database, "Database of the station")->required();
  command
      ->add_option("--to", arguments->to,
                   "postgresql://USER@HOST/DATABASE, without a password: that is taken from "
                   "~/.pgpass, PGPASSWORD or a service file")
      ->required();
  command->add_option("--key", arguments->key,
                      "Key of the study, to open the sealed ends of sessions (default: DB.key, if "
                      "there)");
  command->add_flag("--dry-run", arguments->dry_run, "Look what would be pushed; change nothing");
  command->add_flag("--json", arguments->json, "Summary as one JSON object");
  command->callback([=, &action] { action = [=] { return sync(*arguments); }; });
}

}  // namespace touchtrial::app
