// Commands that end a study's collection and open its outcomes: close and unblind.
#include "analysis/outcomes/looks.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"
#include "record/study_store.hpp"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

/// The participants whose sessions are open and could be continued; may be empty.
std::string left_open(const record::StudyStore& store) {
  std::string participants;
  for (const record::SessionRow& row : store.sessions()) {
    if (!row.can_resume()) continue;
    participants += (participants.empty() ? "" : ", ") + row.participant;
  }
  return participants;
}

struct CloseArguments {
  fs::path database;
  SigningFiles files;
  bool yes = false;
};

int close(const CloseArguments& arguments) {
  const fs::path& database = arguments.database;
  record::StudyStore store = opened_to_record(database, arguments.files);
  const std::string open = left_open(store);
  if (!store.state().closed) {
    confirm(fmt::format("{}: accepts no further session, permanently; it has {}{}",
                        database.string(), store.sessions().size(),
                        open.empty() ? ", and none is open"
                                     : ", and those of these participants are open and cannot be "
                                       "continued: " +
                                           open),
            arguments.yes);
  }
  store.close_study(utc_now());
  if (!open.empty()) {
    spdlog::warn("{}", one_line(database.string() +
                                ": the sessions of these participants are open, and can no longer "
                                "be continued: " +
                                open));
  }
  print(database.string() + ": collection is closed\n");
  print_head(store, database);
  return 0;
}

struct UnblindArguments {
  fs::path database;
  SigningFiles files;
  std::string participant;
  std::string reason;
  bool interim = false;
  bool unregistered = false;
  bool yes = false;
};

/// Whether the look shows only the registered question.
/// \throws StoreError if the registration has looks, but none at this number of participants
bool is_registered_look(const record::StudyStore& store, const UnblindArguments& arguments) {
  if (!arguments.interim || arguments.unregistered || store.state().closed) return false;
  const study::StudyKey key = key_of_database(store, arguments.database, arguments.files.key);
  const auto& analysis = key.study.registration.analysis;
  if (!analysis || analysis->looks.empty()) return false;
  const analysis::LookRecord looked = analysis::look_record(store, key);
  if (looked.may_look) return true;
  std::vector<std::string> registered;
  for (const int look : analysis->looks) registered.push_back(std::to_string(look));
  const std::string why =
      key.stations.size() > 1
          ? "a study of several stations has no registered looks, because one at a merged file "
            "would not be in the next merge"
          : counted(looked.participants, "participant") +
                (looked.participants == 1 ? " is" : " are") + " complete, and the registered " +
                (registered.size() == 1 ? "look is at " : "looks are at ") +
                listed(registered, " and ");
  throw StoreError(one_line(arguments.database.string() + ": " + why +
                            "; wait, or look at everything with --unregistered, which the report "
                            "lists as a departure from the plan"));
}

/// \param registered  the look shows only the registered question
/// \throws StoreError if the last look was of the same kind, and shows the same sessions
void refuse_same_look(const record::StudyStore& store, const UnblindArguments& arguments,
                      bool registered) {
  const record::StudyState state = store.state();
  const std::optional<std::set<int>>& last = registered ? state.question : state.interim;
  if (!arguments.interim || state.closed || !last) return;
  std::set<int> ended;
  for (const record::SessionRow& row : store.sessions()) {
    if (row.state != record::SessionState::open) ended.insert(row.session);
  }
  if (ended != *last) return;
  throw StoreError(
      one_line(arguments.database.string() +
               ": nothing has been collected since the last look, which shows every session that "
               "has ended; `touchtrial report` shows it again, and no other look is recorded"));
}

/// Asks before outcomes are shown, because that cannot be undone. The store refuses forbidden
/// looks.
/// \param registered  the look shows only the registered question
void confirm_look(const record::StudyStore& store, const UnblindArguments& arguments,
                  bool registered) {
  const bool one = !arguments.participant.empty();
  if (!one && store.state().closed == arguments.interim) return;
  const std::string who = one ? "participant " + arguments.participant
                          : arguments.interim
                              ? "every session that has ended"
                              : fmt::format("all {} sessions", store.sessions().size());
  const std::string what =
      registered ? "the answer to the registered question, from " : "the outcomes of ";
  const std::string when = !one && arguments.interim ? ", while collection continues" : "";
  confirm(arguments.database.string() + ": this lets " + what + who + " be seen" + when +
              "; it is recorded and cannot be undone; anyone who sees them is no longer blind, and "
              "later exclusions say that outcomes had been seen",
          arguments.yes);
}

int unblind(const UnblindArguments& arguments) {
  record::StudyStore store =
      record::StudyStore::open(arguments.database, record::StudyStore::Access::read_write);
  // Outcomes cannot be shown without the key, which signs the look.
  sign_with_files(store, arguments.database,
                  {.key = key_path_for(arguments.database, arguments.files.key),
                   .station = {},
                   .accept_loss = arguments.files.accept_loss});
  const bool registered = arguments.participant.empty() && is_registered_look(store, arguments);
  refuse_same_look(store, arguments, registered);
  confirm_look(store, arguments, registered);
  if (!arguments.participant.empty()) {
    store.look_at(arguments.participant, utc_now(), arguments.reason);
    print(arguments.database.string() + ": the look at participant " + arguments.participant +
          " is recorded; `touchtrial export --participant " + arguments.participant +
          " --key KEY` shows the outcomes\n");
    print_head(store, arguments.database);
    return 0;
  }
  const std::string database = arguments.database.string();
  if (registered) {
    store.look_at_question(utc_now(), arguments.reason);
    print(database +
          ": unblinded for a registered look; `touchtrial report` shows the answer to the "
          "registered question, and nothing else\n");
  } else {
    store.unblind(utc_now(), arguments.reason, arguments.interim);
    print(database + ": unblinded" + (arguments.interim ? " for an interim look\n" : "\n"));
  }
  print_head(store, arguments.database);
  return 0;
}

void add_close_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "close", "End collection: no session can be added", close);
  add_database_argument(command, arguments.database);
  add_signing_options(command, arguments.files);
  add_yes_flag(command, arguments.yes);
}

void add_unblind_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "unblind", "Record a look at the outcomes; report then shows them", unblind);
  add_database_argument(command, arguments.database);
  command.add_option("--reason", arguments.reason, "Why; recorded")->required();
  CLI::Option* interim = command.add_flag("--interim", arguments.interim,
                                          "Look at finished sessions before collection is closed; "
                                          "at a registered look, only at the registered question");
  command
      .add_flag("--unregistered", arguments.unregistered,
                "With --interim: look at everything, regardless of registered looks; the report "
                "lists it as a departure from the plan")
      ->needs(interim);
  command
      .add_option("--participant", arguments.participant,
                  "Look only at this participant's outcomes, at any time")
      ->excludes(interim);
  add_key_option(command, arguments.files.key);
  add_accept_loss_option(command, arguments.files.accept_loss);
  add_yes_flag(command, arguments.yes);
}

}  // namespace

void add_study_end_commands(CLI::App& program, Action& action) {
  add_close_command(program, action);
  add_unblind_command(program, action);
}

}  // namespace touchtrial::app
