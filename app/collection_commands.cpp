// close, unblind: the end of collection and the recorded look at outcomes.
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/key_of_database.hpp"
#include "core/errors.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <memory>
#include <string>

#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct UnblindArguments {
  fs::path database;
  fs::path key;
  std::string reason;
  bool interim = false;
};

/// What can no longer be gone on with; empty if nothing. Whoever withdrew could not anyway.
std::string left_open(const store::StudyStore& store) {
  std::string participants;
  for (const store::SessionRow& row : store.sessions()) {
    if (row.state != store::SessionState::open || row.withdrawn || !row.replaced_by.empty())
      continue;
    participants += (participants.empty() ? "" : ", ") + row.participant;
  }
  return participants;
}

int close(const fs::path& database) {
  store::StudyStore store =
      store::StudyStore::open(database, store::StudyStore::Access::read_write);
  const std::string open = left_open(store);
  store.close_study(utc_now());
  if (!open.empty()) {
    spdlog::warn("{}", one_line(database.string() +
                                ": these participants' sessions are open, and can no longer be "
                                "continued: " +
                                open));
  }
  print(database.string() + ": collection is closed\n");
  return 0;
}

int unblind(const UnblindArguments& arguments) {
  store::StudyStore store =
      store::StudyStore::open(arguments.database, store::StudyStore::Access::read_write);
  // Without it nothing could be shown; better to know before the look is recorded.
  static_cast<void>(key_of_database(store, arguments.database, arguments.key));
  store.unblind(utc_now(), arguments.reason, arguments.interim);
  print(arguments.database.string() + ": unblinded" +
        (arguments.interim ? " for an interim look\n" : "\n"));
  return 0;
}

}  // namespace

void add_close_command(CLI::App& program, Action& action) {
  auto database = std::make_shared<fs::path>();
  CLI::App* command = program.add_subcommand("close", "End collection: no session can be added");
  command->add_option("DB", *database, "Database of the study")->required();
  command->callback([=, &action] { action = [=] { return close(*database); }; });
}

void add_unblind_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<UnblindArguments>();
  CLI::App* command =
      program.add_subcommand("unblind", "Record the look at outcomes, which report then shows");
  command->add_option("DB", arguments->database, "Database of the study")->required();
  command->add_option("--reason", arguments->reason, "Why; recorded")->required();
  command->add_flag("--interim", arguments->interim,
                    "Look at the sessions that have ended, before collection is closed");
  command->add_option("--key", arguments->key, "Key of the study (default: DB.key)");
  command->callback([=, &action] { action = [=] { return unblind(*arguments); }; });
}

}  // namespace touchtrial::app
