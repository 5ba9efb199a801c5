// exclude, replace, withdraw, note: what is recorded of people beside their sessions. None of these
// takes a key. migrate: an older database brought forward.
#include "app/commands.hpp"
#include "app/console.hpp"
#include "core/errors.hpp"
#include "protocols/store/personal_data.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PeopleArguments {
  fs::path database;
  std::string participant;
  std::string reason;
  std::string with;
  std::string deviation;
  std::string text;
  bool after_outcomes = false;
};

store::StudyStore opened(const PeopleArguments& arguments) {
  return store::StudyStore::open(arguments.database, store::StudyStore::Access::read_write);
}

std::string place_of(const PeopleArguments& arguments) {
  return arguments.database.string() + ": participant " + arguments.participant;
}

/// \throws StoreError if there is none
std::vector<store::SessionRow> sessions_of(const store::StudyStore& store,
                                           const PeopleArguments& arguments) {
  std::vector<store::SessionRow> rows = store.sessions_of(arguments.participant);
  if (rows.empty()) {
    throw StoreError(one_line(place_of(arguments) + " has no session; check the participant id"));
  }
  return rows;
}

/// The session that counts, or the last one if all were replaced.
int session_of(const store::StudyStore& store, const PeopleArguments& arguments) {
  // Not simply the last: two stations of a collected study may have used one id.
  if (const auto counts = store.session_of(arguments.participant)) return counts->session;
  return sessions_of(store, arguments).back().session;
}

int exclude(const PeopleArguments& arguments) {
  store::StudyStore store = opened(arguments);
  const int session = session_of(store, arguments);
  const bool seen = store.state().shows(session);
  if (seen && !arguments.after_outcomes) {
    throw StoreError(
        one_line(place_of(arguments) +
                 " cannot be excluded unnoticed: outcomes have been seen; if it must be, give "
                 "--after-outcomes, which is recorded with the reason"));
  }
  store.exclude(
      session, utc_now(),
      (seen && !arguments.reason.empty() ? "after outcomes were seen: " : "") + arguments.reason);
  print(place_of(arguments) + ": excluded (session " + std::to_string(session) + ")\n");
  return 0;
}

int replace(const PeopleArguments& arguments) {
  store::StudyStore store = opened(arguments);
  const store::SessionRow row = sessions_of(store, arguments).back();
  store.replace(row.session, arguments.with, utc_now(), arguments.reason);
  print(place_of(arguments) + ": replaced; " + arguments.with + " inherits enrolment " +
        std::to_string(row.enrolment) + "\n");
  return 0;
}

int note(const PeopleArguments& arguments) {
  store::StudyStore store = opened(arguments);
  store.note(session_of(store, arguments), utc_now(), arguments.deviation, arguments.text);
  print(place_of(arguments) + ": noted\n");
  return 0;
}

constexpr const char* kRemaining =
    "destroy every other copy of the database too (backups, snapshots, sent files): in them the "
    "participant's data can still be read\n";

/// Personal data go even if the key went before, in a withdrawal that was broken off.
bool remove_person(const PeopleArguments& arguments) {
  const fs::path path = store::personal_data_path(arguments.database);
  std::error_code error;
  return fs::exists(path, error) && store::PersonalData(path).remove(arguments.participant);
}

int withdraw(const PeopleArguments& arguments) {
  store::StudyStore store = opened(arguments);
  std::vector<int> sessions;
  const std::vector<store::SessionRow> rows = store.sessions_of(arguments.participant);
  for (const store::SessionRow& row : rows) {
    if (!row.withdrawn) sessions.push_back(row.session);
  }
  // The key first: whatever is wrong with the other file must not keep anybody from withdrawing.
  if (!sessions.empty()) store.withdraw(sessions, utc_now(), arguments.reason);
  const bool removed = remove_person(arguments);
  if (rows.empty() && removed) {
    print(place_of(arguments) + ": had no session; the personal data are removed\n");
    return 0;
  }
  if (rows.empty()) static_cast<void>(sessions_of(store, arguments));  // says that there is none
  if (sessions.empty() && !removed) {
    throw StoreError(one_line(place_of(arguments) + " has already withdrawn"));
  }
  print(place_of(arguments) + ": withdrawn; what was sealed of this person cannot be read again" +
        (removed ? ", and the personal data are removed\n" : "\n") +
        (store.stations() > 0 ? "this is a merged database: withdraw in the station's too\n" : "") +
        kRemaining);
  return 0;
}

int migrate_database(const fs::path& database) {
  {
    const store::StudyStore store =
        store::StudyStore::open(database, store::StudyStore::Access::read_write);
  }
  print(database.string() + ": is up to date\n");
  return 0;
}

struct PeopleCommand {
  CLI::App* command;
  std::shared_ptr<PeopleArguments> arguments;
};

PeopleCommand people_command(CLI::App& program, const char* name, const char* description) {
  auto arguments = std::make_shared<PeopleArguments>();
  CLI::App* command = program.add_subcommand(name, description);
  command->add_option("DB", arguments->database, "Database of the study")->required();
  command->add_option("--participant", arguments->participant, "Participant id")->required();
  return {command, arguments};
}

void add_reason(const PeopleCommand& added) {
  added.command->add_option("--reason", added.arguments->reason, "Why; recorded")->required();
}

void run_with(const PeopleCommand& added, Action& action, int (*work)(const PeopleArguments&)) {
  added.command->callback(
      [arguments = added.arguments, work, &action] { action = [=] { return work(*arguments); }; });
}

}  // namespace

void add_people_commands(CLI::App& program, Action& action) {
  const PeopleCommand excluded =
      people_command(program, "exclude", "Leave a participant out of outcomes");
  add_reason(excluded);
  excluded.command->add_flag("--after-outcomes", excluded.arguments->after_outcomes,
                             "Although this participant's outcomes have been seen; recorded");
  run_with(excluded, action, exclude);
  const PeopleCommand replaced =
      people_command(program, "replace", "Let somebody new take a participant's place");
  replaced.command->add_option("--with", replaced.arguments->with, "Who takes the place")
      ->required();
  add_reason(replaced);
  run_with(replaced, action, replace);
  const PeopleCommand withdrawn = people_command(
      program, "withdraw", "Make what is sealed of a participant unreadable, for ever");
  add_reason(withdrawn);
  run_with(withdrawn, action, withdraw);
  const PeopleCommand noted =
      people_command(program, "note", "Record a remark or a deviation from the protocol");
  noted.command->add_option("--deviation", noted.arguments->deviation, "Code of the deviation");
  noted.command->add_option("TEXT", noted.arguments->text, "What happened")->required();
  run_with(noted, action, note);
  auto database = std::make_shared<fs::path>();
  CLI::App* command = program.add_subcommand(
      "migrate", "Bring an older database up to date; copy it first (none is older yet)");
  command->add_option("DB", *database, "Database of the study")->required();
  command->callback([=, &action] { action = [=] { return migrate_database(*database); }; });
}

}  // namespace touchtrial::app
