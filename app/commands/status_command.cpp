// status: the state of collection, and the command line for the next participant.
#include "analysis/outcomes/study_status.hpp"
#include "analysis/verification/head_check.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/participant_ids.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/utc.hpp"
#include "record/merging/enrolment_balance.hpp"
#include "record/personal_data.hpp"
#include "study/key_protection.hpp"
#include "study/prepare.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct StatusArguments {
  fs::path database;
  fs::path study;
  bool json = false;
};

/// The study file and the station's file beside a database, if they exist.
struct FilesBeside {
  fs::path study;
  std::optional<study::Study> design;
  fs::path station_file;
  std::optional<study::Station> station;  ///< empty also if a passphrase protects the file
};

/// Uses the station's file if it belongs to the database. Never asks for a passphrase.
void take_station_file(const fs::path& file, const record::StudyCommitment& commitment,
                       FilesBeside& beside) {
  if (!commitment.station || !is_there(file)) return;
  try {
    if (const auto signer = study::signer_in_clear(file)) {
      if (*signer == commitment.station->key) beside.station_file = file;
      return;
    }
    const study::StationKey key = study::load_station_key(file);
    if (key.signer().public_half() != commitment.station->key) return;
    beside.station_file = file;
    beside.station = key.station;
  } catch (const Error&) {
    // Another study's, or damaged; `run` reports that. std
  }
}

/// "<study>.json" of "<study>.station" or "<study>.NAME.station".
fs::path study_file_of(const fs::path& station_file, const std::string& station) {
  fs::path study = station_file;
  study.replace_extension();
  if (study.extension() == "." + station) study.replace_extension();
  study += ".json";
  return study;
}

/// Uses the study in the key beside a database that was simulated without a prepared study.
void take_simulated_key(const fs::path& database, const record::StudyCommitment& commitment,
                        FilesBeside& beside) {
  const fs::path path = key_path_for(database, {});
  if (!commitment.simulated || !is_there(path) || study::is_protected(path)) return;
  try {
    const study::StudyKey key = study::load_study_key(path);
    if (key.simulated && key.seal == commitment.seal) beside.design = key.study;
  } catch (const Error&) {
    // Another study's, or damaged; `report` reports that.
  }
}

/// The study file that a station's file beside it belongs to, if it can be read.
void take_study_of_station(const std::string& station, FilesBeside& beside) {
  const fs::path study = study_file_of(beside.station_file, station);
  if (!is_there(study)) return;
  try {
    beside.design = study::load_study(study);
    beside.study = study;
  } catch (const Error&) {
    // Edited since; `run` reports that.
  }
}

/// Calls `see` with each file of a station beside the database, and then in the current folder.
template <typename See>
void for_each_station_file(const fs::path& database, See see) {
  for (const fs::path& folder : {database.parent_path(), fs::path(".")}) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
      if (entry.path().extension() == ".station") see(entry.path().lexically_normal());
    }
  }
}

FilesBeside files_beside(const StatusArguments& arguments,
                         const record::StudyCommitment& commitment) {
  FilesBeside beside;
  const std::string station = commitment.station ? commitment.station->name : "";
  if (!arguments.study.empty()) {
    beside.study = arguments.study;
    beside.design = study::load_study(arguments.study);
    if (beside.design->name != commitment.study) {
      throw StudyError(arguments.study.string() + ": is the study " + beside.design->name +
                       ", and the database is of " + one_line(commitment.study) +
                       "; name its study file with --study");
    }
    take_station_file(pack_place_for(arguments.study, {}).station(station), commitment, beside);
    return beside;
  }
  for_each_station_file(arguments.database, [&](const fs::path& file) {
    if (beside.station_file.empty()) take_station_file(file, commitment, beside);
  });
  if (beside.station_file.empty()) {
    take_simulated_key(arguments.database, commitment, beside);
  } else {
    take_study_of_station(station, beside);
  }
  return beside;
}

/// Without a database: the named study, or that of the only station's file.
FilesBeside files_before(const StatusArguments& arguments) {
  FilesBeside beside;
  if (!arguments.study.empty()) {
    beside.study = arguments.study;
    beside.design = study::load_study(arguments.study);
    return beside;
  }
  std::set<fs::path> files;
  for_each_station_file(arguments.database, [&](const fs::path& file) {
    files.insert(fs::weakly_canonical(file));
    beside.station_file = file;
  });
  if (files.size() != 1) return {};
  std::string station = study::kOnlyStation;
  try {
    if (!study::is_protected(beside.station_file)) {
      beside.station = study::load_station_key(beside.station_file).station;
      station = beside.station->name;
    }
  } catch (const Error&) {
    return {};  // damaged; `run` reports that
  }
  take_study_of_station(station, beside);
  return beside;
}

analysis::StatusSources sources_for(const StatusArguments& arguments, const FilesBeside& beside) {
  analysis::StatusSources sources;
  sources.consents = consents_beside(arguments.database);
  sources.knows_consents = !sources.consents.empty();
  sources.station = beside.station;
  if (!beside.design) return sources;
  sources.planned = beside.design->registration.participants;
  sources.consent_version = beside.design->session.consent_version;
  return sources;
}

/// Sentences on the balance of stations and enrolment numbers. A station's own numbers need not
/// begin at 1.
std::vector<std::string> balance_of(const record::StudyStore& store) {
  const record::StudyCommitment& commitment = store.commitment();
  if (commitment.station && commitment.station->name != study::kOnlyStation) return {};
  std::vector<merging::EnrolledSession> sessions;
  for (const record::SessionRow& row : store.sessions()) {
    sessions.push_back({.station = std::max(row.station, 1),
                        .enrolment = row.enrolment,
                        .state = row.state,
                        .counts = !row.excluded && !row.withdrawn && row.replaced_by.empty()});
  }
  return merging::imbalances(merging::enrolment_balance(sessions));
}

/// A session to run next.
struct NextSession {
  std::string participant;
  int visit = 1;
  bool is_open = false;
  std::string from{};  ///< earliest time, as text; empty: now
};

/// Whether the planned number of participants has been reached, so that no new one is due.
bool all_planned_present(const analysis::StudyStatus& status) {
  std::set<std::string> participants;
  for (const analysis::PersonStatus& one : status.people) {
    const bool is_planned =
        one.state == "complete" || one.state == "open" || one.state == "stopped";
    if (is_planned) participants.insert(one.participant);
  }
  return status.planned > 0 && static_cast<int>(participants.size()) >= status.planned;
}

/// The next participant: that of an open session, one who has consented or replaces another, one
/// whose next visit is due, or a new id.
std::optional<NextSession> next_session(const analysis::StudyStatus& status) {
  std::vector<std::string> known;
  for (const analysis::PersonStatus& one : status.people) {
    if (one.can_resume || one.state == "to come") {
      return NextSession{one.participant, one.visit, one.can_resume};
    }
    if (!one.participant.empty()) known.push_back(one.participant);
  }
  if (!status.upcoming_visits.empty()) {
    const analysis::UpcomingVisit& visit = status.upcoming_visits.front();
    const bool is_due = visit.is_due(utc_now());
    if (is_due || all_planned_present(status)) {
      return NextSession{visit.participant, visit.visit, false,
                         is_due ? "" : utc_words(*visit.from)};
    }
  }
  const std::optional<std::string> id = next_id(known);
  if (!id) return std::nullopt;
  return NextSession{*id};
}

/// The parts of a command line from a database: the names of its station and of its last device.
struct DatabaseWords {
  std::string station = study::kOnlyStation;
  std::string device{};
};

DatabaseWords database_words(const record::StudyStore& store) {
  DatabaseWords words;
  words.station = store.commitment().station ? store.commitment().station->name : "";
  const std::vector<record::SessionRow> rows = store.sessions();
  if (!rows.empty()) words.device = rows.back().device;
  return words;
}

std::string run_line(const StatusArguments& arguments, const FilesBeside& beside,
                     const DatabaseWords& words, const NextSession& next, bool pilot) {
  const std::string study = beside.study.empty() ? "STUDY" : shell_word(beside.study.string());
  std::string line = "touchtrial run " + study + " --participant " + shell_word(next.participant) +
                     " --db " + shell_word(arguments.database.string());
  const bool is_default =
      beside.study.empty() || beside.station_file.empty() ||
      beside.station_file.lexically_normal() ==
          pack_place_for(beside.study, {}).station(words.station).lexically_normal();
  if (!is_default) {
    line += " --station-file " + shell_word(beside.station_file.string());
  } else if (words.station != study::kOnlyStation) {
    line += " --station " + shell_word(words.station);
  }
  if (next.visit > 1) line += " --visit " + std::to_string(next.visit);
  if (!words.device.empty()) line += " --device " + words.device;
  if (pilot) line += " --pilot";
  return line + (next.is_open ? " --on-existing resume" : "");
}

std::string next_session_text(const NextSession& next) {
  const std::string visit =
      next.visit > 1 ? "visit " + std::to_string(next.visit) : std::string("session");
  return (next.is_open ? "resume the " : "") + visit + " of " + next.participant +
         (next.from.empty() ? "" : ", from " + next.from);
}

/// Empty if sessions are recorded elsewhere, are simulated, or are over.
std::vector<analysis::NextCommand> next_commands(const StatusArguments& arguments,
                                                 const FilesBeside& beside,
                                                 const DatabaseWords& words,
                                                 const analysis::StudyStatus& status) {
  const bool records = status.stations == 0 && !status.state.closed && !status.simulated;
  if (!records) return {};
  const std::optional<NextSession> session = next_session(status);
  if (!session) return {};
  const std::string& id = session->participant;
  const bool has_consented =
      std::ranges::any_of(status.people, [&](const analysis::PersonStatus& one) {
        return one.participant == id && !one.consent.empty();
      });
  std::vector<analysis::NextCommand> next;
  if (!has_consented) {
    const std::string version = beside.design && !beside.design->session.consent_version.empty()
                                    ? beside.design->session.consent_version
                                    : "VERSION";
    next.push_back({"consent of " + id, "touchtrial consent " +
                                            shell_word(arguments.database.string()) +
                                            " --participant " + shell_word(id) + " --version " +
                                            shell_word(version) + " --details -"});
  }
  next.push_back(
      {next_session_text(*session), run_line(arguments, beside, words, *session, status.pilot)});
  return next;
}

void print_status(const StatusArguments& arguments, const FilesBeside& beside,
                  const DatabaseWords& words, const analysis::StudyStatus& status) {
  const auto next = next_commands(arguments, beside, words, status);
  print(arguments.json ? analysis::status_json(status, next) : analysis::status_text(status, next));
}

/// Before the first session: the consents so far, and the first command line.
int show_before(const StatusArguments& arguments) {
  const FilesBeside beside = files_before(arguments);
  const analysis::StatusSources sources = sources_for(arguments, beside);
  if (!beside.design && sources.consents.empty()) {
    throw StoreError(one_line(arguments.database.string()) +
                     ": there is neither such a database nor a consent or a study beside it; check "
                     "the name, or name the study file with --study");
  }
  DatabaseWords words;
  if (beside.station) words.station = beside.station->name;
  print_status(
      arguments, beside, words,
      analysis::status_before(beside.design ? beside.design->name : "",
                              beside.design ? beside.design->protocol_name() : "", sources));
  return 0;
}

int show_status(const StatusArguments& arguments) {
  if (!is_there(arguments.database)) return show_before(arguments);
  const record::StudyStore store =
      record::StudyStore::open(arguments.database, record::StudyStore::Access::read_only);
  const FilesBeside beside = files_beside(arguments, store.commitment());
  analysis::StudyStatus status = analysis::status_of(store, sources_for(arguments, beside));
  status.balance = balance_of(store);
  status.head_fault = analysis::check_heads(store, arguments.database).fault();
  print_status(arguments, beside, database_words(store), status);
  return status.head_fault.empty() ? 0 : kNotVerified;
}

}  // namespace

void add_status_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "status",
      "Finished and open sessions, remaining work, and the command for the next participant",
      show_status);
  add_database_argument(command, arguments.database);
  command.add_option("--study", arguments.study,
                     "Study file (default: the one of the station's file beside the database or "
                     "here)");
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
