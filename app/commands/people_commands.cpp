// Commands that record a decision about one participant: exclude, replace, withdraw and note.
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/nearest_name.hpp"
#include "core/text.hpp"
#include "record/personal_data.hpp"
#include "record/study_store.hpp"
#include "study/deviation_codes.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PeopleArguments {
  fs::path database;
  SigningFiles files;
  std::string participant;
  std::string reason;
  std::string new_participant;
  std::string deviation;
  std::string text;
  bool own_code = false;
  bool after_outcomes = false;
  bool keep_data = false;
  bool erase = false;
  bool erase_safety = false;
  bool yes = false;
};

std::string location_of(const PeopleArguments& arguments) {
  return arguments.database.string() + ": participant " + arguments.participant;
}

/// \throws StoreError if the participant has no session
std::vector<record::SessionRow> sessions_of(const record::StudyStore& store,
                                            const PeopleArguments& arguments) {
  std::vector<record::SessionRow> rows = store.sessions_of(arguments.participant);
  if (rows.empty()) {
    throw StoreError(
        one_line(location_of(arguments) + " has no session; check the participant id"));
  }
  return rows;
}

/// The session that counts, or the last one if all were replaced.
int session_of(const record::StudyStore& store, const PeopleArguments& arguments) {
  // Not always the last one: two stations of a merged study may have used the same id.
  if (const auto counted_session = store.session_of(arguments.participant))
    return counted_session->session;
  return sessions_of(store, arguments).back().session;
}

int exclude(const PeopleArguments& arguments) {
  record::StudyStore store = open_for_recording(arguments.database, arguments.files);
  // Excludes all visits that are not yet excluded.
  std::vector<int> sessions = {session_of(store, arguments)};
  for (const record::SessionRow& row : sessions_of(store, arguments)) {
    const bool is_other = row.session != sessions.front() && !row.excluded;
    if (is_other && row.replaced_by.empty()) sessions.push_back(row.session);
  }
  const record::StudyState state = store.state();
  const bool are_outcomes_seen =
      std::ranges::any_of(sessions, [&](int session) { return state.shows(session); });
  if (are_outcomes_seen && !arguments.after_outcomes) {
    throw StoreError(one_line(
        location_of(arguments) +
        ": outcomes have been seen, so an exclusion could be biased; give --after-outcomes to "
        "exclude anyway, which is recorded with the reason"));
  }
  for (const int session : sessions) store.exclude(session, utc_now(), arguments.reason);
  print(location_of(arguments) + ": excluded (session " +
        listed(sessions, ", ", [](int session) { return std::to_string(session); }) + ")\n");
  print_head(store, arguments.database);
  return 0;
}

int replace(const PeopleArguments& arguments) {
  record::StudyStore store = open_for_recording(arguments.database, arguments.files);
  const record::SessionRow row = sessions_of(store, arguments).back();
  store.replace(row.session, arguments.new_participant, utc_now(), arguments.reason);
  print(location_of(arguments) + ": replaced; " + arguments.new_participant +
        " inherits enrolment " + std::to_string(row.enrolment) + "\n");
  print_head(store, arguments.database);
  return 0;
}

/// Refuses a mistyped code, which would not be counted.
/// \throws UsageError with the valid codes
void check_code(const PeopleArguments& arguments) {
  const std::string& code = arguments.deviation;
  if (code.empty() || arguments.own_code || study::is_deviation_code(code)) return;
  const auto nearest = nearest_name(code, study::kDeviationCodes);
  throw UsageError("note: --deviation " + one_line(code) + " is not a built-in code" +
                   (nearest ? "; did you mean " + std::string(*nearest) + "?" : ": ") +
                   (nearest ? " The codes are " : "") + listed(study::kDeviationCodes) +
                   ", no-day-sheet-NUMBER; for a code defined by your study, add --own-code");
}

int note(const PeopleArguments& arguments) {
  check_code(arguments);
  record::StudyStore store = open_for_recording(arguments.database, arguments.files);
  store.note(session_of(store, arguments), utc_now(), arguments.deviation, arguments.text);
  print(location_of(arguments) + ": noted\n");
  print_head(store, arguments.database);
  return 0;
}

constexpr const char* kOtherCopies =
    "destroy every other copy of the database too (backups, snapshots, files that were sent): the "
    "participant's data can still be read in them\n"
    "if the database was sent to a server, run `touchtrial sync` now, which lists the rows with "
    "the key: it stays there and in the server's backups until the owner deletes these rows\n";
/// Recorded in the withdrawal's event.
constexpr const char* kNotErased =
    "other copies and backups; the key on a server, until its row is deleted";

/// Removes personal data, even if an interrupted withdrawal has already destroyed the key.
bool remove_person(const PeopleArguments& arguments) {
  const fs::path path = record::personal_data_path(arguments.database);
  return path_exists(path) && record::PersonalData(path).remove(arguments.participant);
}

/// The participant's sessions that satisfy a condition.
std::vector<int> sessions_where(const record::StudyStore& store, const std::string& participant,
                                bool (*matches)(const record::SessionRow&)) {
  std::vector<int> sessions;
  for (const record::SessionRow& row : store.sessions_of(participant)) {
    if (matches(row)) sessions.push_back(row.session);
  }
  return sessions;
}

std::vector<int> unerased_sessions(const record::StudyStore& store,
                                   const std::string& participant) {
  return sessions_where(store, participant,
                        [](const record::SessionRow& row) { return !row.erased; });
}

/// Describes each of these sessions, for instance "session 3 with 25 answers".
std::string sessions_text(const record::StudyStore& store, const std::vector<int>& sessions) {
  const std::vector<record::TrialRow> trials = store.trials();
  std::vector<std::string> words;
  for (const int session : sessions) {
    const auto answers = std::ranges::count_if(trials, [session](const record::TrialRow& trial) {
      return trial.session == session && trial.state == record::TrialState::answered;
    });
    words.push_back(fmt::format("session {} with {}", session, counted(answers, "answer")));
  }
  return listed(words);
}

/// Asks before an erasure that would destroy something.
void confirm_erasure(const record::StudyStore& store, const std::vector<int>& sessions,
                     const PeopleArguments& arguments) {
  const fs::path path = record::personal_data_path(arguments.database);
  std::string erased_items = sessions_text(store, sessions);
  if (path_exists(path) && record::PersonalData(path).find(arguments.participant)) {
    erased_items +=
        std::string(erased_items.empty() ? "" : ", ") + "and the personal data (consent, contact)";
  }
  if (erased_items.empty()) return;
  confirm(location_of(arguments) + ": " + erased_items +
              ": they can never be read again; the safety record is kept",
          arguments.yes);
}

/// Destroys the keys of these sessions, and any copies that an earlier call left in the log.
/// \return what remains of the keys, and the remedy; empty if nothing
/// \throws StoreError if the withdrawal was not recorded
std::string destroy_keys(record::StudyStore& store, const std::vector<int>& sessions,
                         const PeopleArguments& arguments) {
  try {
    store.withdraw(sessions, utc_now(), arguments.reason, record::Retention::safety_record,
                   kNotErased);
  } catch (const StoreError& error) {
    if (!unerased_sessions(store, arguments.participant).empty()) throw;
    return error.what();
  }
  return "";
}

int keep_data(const PeopleArguments& arguments) {
  record::StudyStore store = open_for_recording(arguments.database, arguments.files);
  static_cast<void>(sessions_of(store, arguments));  // throws if there are none
  const std::vector<int> sessions = sessions_where(
      store, arguments.participant, [](const record::SessionRow& row) { return !row.withdrawn; });
  if (sessions.empty())
    throw StoreError(one_line(location_of(arguments) + " has already withdrawn"));
  confirm(location_of(arguments) +
              ": leaves the study permanently, and an open session cannot continue; the data are "
              "kept (" +
              sessions_text(store, sessions) + ")",
          arguments.yes);
  store.withdraw(sessions, utc_now(), arguments.reason, record::Retention::data);
  print(location_of(arguments) +
        ": withdrawn; the data are kept and analysed as the study states, and reports state how "
        "many participants allow this\n"
        "to erase them later, run the same command with --erase\n");
  print_head(store, arguments.database);
  return 0;
}

int erase_safety(const PeopleArguments& arguments) {
  record::StudyStore store = open_for_recording(arguments.database, arguments.files);
  std::vector<int> sessions;
  for (const record::SessionRow& row : sessions_of(store, arguments)) {
    if (store.wrapped_keys(row.session).safety) sessions.push_back(row.session);
  }
  if (sessions.empty()) {
    throw StoreError(one_line(location_of(arguments) + ": the safety record is already erased"));
  }
  confirm(location_of(arguments) +
              ": the texts of the safety record can never be read again (stops, faults, largest "
              "forces, reasons of deviations)",
          arguments.yes);
  store.withdraw(sessions, utc_now(), "", record::Retention::nothing, kNotErased);
  print(location_of(arguments) + ": the texts of the safety record can never be read again\n" +
        kOtherCopies);
  print_head(store, arguments.database);
  return 0;
}

int erase(const PeopleArguments& arguments) {
  std::error_code log_error;
  const auto log_size = fs::file_size(arguments.database.string() + "-wal", log_error);
  const bool had_log =
      !log_error && log_size > 0;  // an earlier withdrawal may have left a key there
  record::StudyStore store = open_for_recording(arguments.database, arguments.files);
  const bool has_session = !store.sessions_of(arguments.participant).empty();
  const std::vector<int> sessions = unerased_sessions(store, arguments.participant);
  confirm_erasure(store, sessions, arguments);
  // Keys first, so that unreadable personal data do not prevent a withdrawal.
  std::string remaining = has_session ? destroy_keys(store, sessions, arguments) : "";
  bool is_removed = false;
  try {
    is_removed = remove_person(arguments);
  } catch (const Error& error) {
    remaining += (remaining.empty() ? "" : "; ") +
                 std::string("the personal data are not yet removed: ") + error.what();
  }
  if (!remaining.empty()) {
    throw StoreError(one_line(location_of(arguments) + ": not everything is erased yet: " +
                              remaining + "; then run the same command again"));
  }
  if (!has_session && is_removed) {
    print(location_of(arguments) + ": had no session; the personal data are removed\n");
    return 0;
  }
  if (!has_session) static_cast<void>(sessions_of(store, arguments));  // throws
  if (sessions.empty() && !is_removed && !had_log) {
    throw StoreError(
        one_line(location_of(arguments) + " has already withdrawn, and the data are erased"));
  }
  print(location_of(arguments) +
        ": withdrawn; this person's sealed data can no longer be read, except the safety record" +
        (is_removed ? ", and the personal data are removed\n" : "\n") +
        (store.stations() > 0 ? "this is a merged database: withdraw at the station too\n" : "") +
        kOtherCopies);
  if (!sessions.empty()) print_head(store, arguments.database);
  return 0;
}

int withdraw(const PeopleArguments& arguments) {
  if (int{arguments.keep_data} + int{arguments.erase} + int{arguments.erase_safety} != 1) {
    throw UsageError(
        "withdraw: give --reason, and --keep-data (the person leaves the study, the data are "
        "kept), --erase (the data are destroyed, the safety record is kept) or --erase-safety "
        "(after its retention period); let the person choose");
  }
  if (arguments.erase_safety) return erase_safety(arguments);
  if (arguments.reason.empty()) {
    throw StoreError(location_of(arguments) +
                     ": a withdrawal needs a reason, which is recorded; give one with --reason");
  }
  return arguments.erase ? erase(arguments) : keep_data(arguments);
}

using PeopleCommand = Command<PeopleArguments>;

PeopleCommand people_command(CLI::App& program, Action& action, const char* name,
                             const char* meaning, int (*work)(const PeopleArguments&)) {
  const auto [command, arguments] = add_command(program, action, name, meaning, work);
  add_database_argument(command, arguments.database);
  add_signing_options(command, arguments.files);
  command.add_option("--participant", arguments.participant, "Participant id")->required();
  return {command, arguments};
}

void add_reason_option(CLI::App& command, std::string& reason) {
  command.add_option("--reason", reason, "The reason, which is recorded")->required();
}

}  // namespace

void add_people_commands(CLI::App& program, Action& action) {
  const PeopleCommand exclude_command = people_command(
      program, action, "exclude", "Exclude a participant from the outcomes", exclude);
  add_reason_option(exclude_command.command, exclude_command.arguments.reason);
  exclude_command.command.add_flag(
      "--after-outcomes", exclude_command.arguments.after_outcomes,
      "Exclude although this participant's outcomes have been seen, which is recorded");
  const PeopleCommand replace_command =
      people_command(program, action, "replace", "Replace a participant with a new one", replace);
  replace_command.command
      .add_option("--with", replace_command.arguments.new_participant, "Id of the new participant")
      ->required();
  add_reason_option(replace_command.command, replace_command.arguments.reason);
  const PeopleCommand withdraw_command = people_command(
      program, action, "withdraw", "Withdraw a participant; keep the data or erase them", withdraw);
  CLI::Option* reason = withdraw_command.command.add_option(
      "--reason", withdraw_command.arguments.reason, "The reason, which is recorded");
  withdraw_command.command
      .add_flag("--keep-data", withdraw_command.arguments.keep_data,
                "Keep the data, and analyse them as the study states")
      ->needs(reason);
  withdraw_command.command
      .add_flag("--erase", withdraw_command.arguments.erase,
                "Make the sealed data permanently unreadable, and remove the personal data; the "
                "safety record stays")
      ->needs(reason);
  withdraw_command.command.add_flag(
      "--erase-safety", withdraw_command.arguments.erase_safety,
      "Make the safety record of an erased participant unreadable too, "
      "after the study's retention period");
  add_yes_flag(withdraw_command.command, withdraw_command.arguments.yes);
  const PeopleCommand note_command = people_command(
      program, action, "note", "Record a remark or a deviation from the protocol", note);
  note_command.command.add_option(
      "--deviation", note_command.arguments.deviation,
      "Code of the deviation: " + listed(study::kDeviationCodes) + ", no-day-sheet-NUMBER");
  note_command.command.add_flag("--own-code", note_command.arguments.own_code,
                                "Accept a code that is not in the list");
  note_command.command.add_option("TEXT", note_command.arguments.text, "What happened")->required();
}

}  // namespace touchtrial::app
