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
std::string open_participants(const record::StudyStore& store) {
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
  record::StudyStore store = open_for_recording(database, arguments.files);
  const std::string open_ids = open_participants(store);
  if (!store.state().closed) {
    confirm(
        fmt::format("{}: will never accept another session; it has {}{}", database.string(),
                    store.sessions().size(),
                    open_ids.empty() ? ", and none is open"
                                     : ", and those of these participants are open and cannot be "
                                       "continued: " +
                                           open_ids),
        arguments.yes);
  }
  store.close_study(utc_now());
  if (!open_ids.empty()) {
    spdlog::warn("{}", one_line(database.string() +
                                ": the sessions of these participants are open, and can no longer "
                                "be continued: " +
                                open_ids));
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
  const analysis::LookRecord looks = analysis::look_record(store, key);
  if (looks.may_look) return true;
  std::vector<std::string> registered_looks;
  for (const int look : analysis->looks) registered_looks.push_back(std::to_string(look));
  const std::string reason =
      key.stations.size() > 1
          ? "a study of several stations has no registered looks, because a look at a merged "
            "file would not be in the next merge"
          : counted(looks.participants, "participant") +
                (looks.participants == 1 ? " is" : " are") + " complete, and the registered " +
                (registered_looks.size() == 1 ? "look is at " : "looks are at ") +
                listed(registered_looks, " and ");
  throw StoreError(one_line(arguments.database.string() + ": " + reason +
                            "; wait, or look at everything with --unregistered, which the report "
                            "lists as a departure from the plan"));
}

/// \param is_registered  the look shows only the registered question
/// \throws StoreError if the last look was of the same kind, and shows the same sessions
void refuse_same_look(const record::StudyStore& store, const UnblindArguments& arguments,
                      bool is_registered) {
  const record::StudyState state = store.state();
  const std::optional<std::set<int>>& last_look = is_registered ? state.question : state.interim;
  if (!arguments.interim || state.closed || !last_look) return;
  std::set<int> ended_sessions;
  for (const record::SessionRow& row : store.sessions()) {
    if (row.state != record::SessionState::open) ended_sessions.insert(row.session);
  }
  if (ended_sessions != *last_look) return;
  throw StoreError(
      one_line(arguments.database.string() +
               ": nothing has been collected since the last look, which shows every session that "
               "has ended; `touchtrial report` shows it again, and no other look is recorded"));
}

/// Asks for confirmation before outcomes are shown, because that cannot be undone. The store
/// refuses forbidden looks.
/// \param is_registered  the look shows only the registered question
void confirm_look(const record::StudyStore& store, const UnblindArguments& arguments,
                  bool is_registered) {
  const bool is_single = !arguments.participant.empty();
  if (!is_single && store.state().closed == arguments.interim) return;
  const std::string scope = is_single ? "participant " + arguments.participant
                            : arguments.interim
                                ? "every session that has ended"
                                : fmt::format("all {} sessions", store.sessions().size());
  const std::string content =
      is_registered ? "the answer to the registered question, from " : "the outcomes of ";
  const std::string condition =
      !is_single && arguments.interim ? ", while collection continues" : "";
  confirm(arguments.database.string() + ": this reveals " + content + scope + condition +
              "; it is recorded and cannot be undone; anyone who sees them is no longer blind, and "
              "later exclusions state that outcomes had been seen",
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
  const bool is_registered = arguments.participant.empty() && is_registered_look(store, arguments);
  refuse_same_look(store, arguments, is_registered);
  confirm_look(store, arguments, is_registered);
  if (!arguments.participant.empty()) {
    store.look_at(arguments.participant, utc_now(), arguments.reason);
    print(arguments.database.string() + ": the look at participant " + arguments.participant +
          " is recorded; `touchtrial export --participant " + arguments.participant +
          " --key KEY` shows the outcomes\n");
    print_head(store, arguments.database);
    return 0;
  }
  const std::string database = arguments.database.string();
  if (is_registered) {
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
  command.add_option("--reason", arguments.reason, "The reason, which is recorded")->required();
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
