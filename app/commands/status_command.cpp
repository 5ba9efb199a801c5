// status: prints the state of collection, and the command line for the next participant.
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

/// The study file and the station's file of a database, if they exist.
struct StatusFiles {
  fs::path study;
  std::optional<study::Study> design;
  fs::path station_file;
  std::optional<study::Station> station;  ///< empty also if a passphrase protects the file
};

/// Uses the station's file if it belongs to the database. Never asks for a passphrase.
void use_station_file(const fs::path& file, const record::StudyCommitment& commitment,
                      StatusFiles& study_files) {
  if (!commitment.station || !path_exists(file)) return;
  try {
    if (const auto signer = study::unencrypted_signer(file)) {
      if (*signer == commitment.station->key) study_files.station_file = file;
      return;
    }
    const study::StationKey key = study::load_station_key(file);
    if (key.signer().public_half() != commitment.station->key) return;
    study_files.station_file = file;
    study_files.station = key.station;
  } catch (const Error&) {
    // The file is another study's, or damaged; `run` reports that.
  }
}

/// The path "<study>.json" for "<study>.station" or "<study>.NAME.station".
fs::path study_file_of(const fs::path& station_file, const std::string& station) {
  fs::path study = station_file;
  study.replace_extension();
  if (study.extension() == "." + station) study.replace_extension();
  study += ".json";
  return study;
}

/// Uses the study in the key beside a database that was simulated without a prepared study.
void use_simulated_key(const fs::path& database, const record::StudyCommitment& commitment,
                       StatusFiles& study_files) {
  const fs::path path = key_path_for(database, {});
  if (!commitment.simulated || !path_exists(path) || study::is_protected(path)) return;
  try {
    const study::StudyKey key = study::load_study_key(path);
    if (key.simulated && key.seal == commitment.seal) study_files.design = key.study;
  } catch (const Error&) {
    // The key is another study's, or damaged; `report` reports that.
  }
}

/// Uses the study file beside the station's file, if it can be read.
void use_study_of_station(const std::string& station, StatusFiles& study_files) {
  const fs::path study = study_file_of(study_files.station_file, station);
  if (!path_exists(study)) return;
  try {
    study_files.design = study::load_study(study);
    study_files.study = study;
  } catch (const Error&) {
    // The study file was edited; `run` reports that.
  }
}

/// Calls `visit` for each station's file beside the database, and then in the current folder.
template <typename Visit>
void for_each_station_file(const fs::path& database, Visit visit) {
  for (const fs::path& folder : {database.parent_path(), fs::path(".")}) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
      if (entry.path().extension() == ".station") visit(entry.path().lexically_normal());
    }
  }
}

StatusFiles find_files(const StatusArguments& arguments,
                       const record::StudyCommitment& commitment) {
  StatusFiles study_files;
  const std::string station = commitment.station ? commitment.station->name : "";
  if (!arguments.study.empty()) {
    study_files.study = arguments.study;
    study_files.design = study::load_study(arguments.study);
    if (study_files.design->name != commitment.study) {
      throw StudyError(arguments.study.string() + ": is the study " + study_files.design->name +
                       ", but the database belongs to " + one_line(commitment.study) +
                       "; name its study file with --study");
    }
    use_station_file(pack_place_for(arguments.study, {}).station(station), commitment, study_files);
    return study_files;
  }
  for_each_station_file(arguments.database, [&](const fs::path& file) {
    if (study_files.station_file.empty()) use_station_file(file, commitment, study_files);
  });
  if (study_files.station_file.empty()) {
    use_simulated_key(arguments.database, commitment, study_files);
  } else {
    use_study_of_station(station, study_files);
  }
  return study_files;
}

/// Finds the files before a database exists: those of the named study, or of the only station.
StatusFiles find_files_without_database(const StatusArguments& arguments) {
  StatusFiles study_files;
  if (!arguments.study.empty()) {
    study_files.study = arguments.study;
    study_files.design = study::load_study(arguments.study);
    return study_files;
  }
  std::set<fs::path> files;
  for_each_station_file(arguments.database, [&](const fs::path& file) {
    files.insert(fs::weakly_canonical(file));
    study_files.station_file = file;
  });
  if (files.size() != 1) return {};
  std::string station = study::kOnlyStation;
  try {
    if (!study::is_protected(study_files.station_file)) {
      study_files.station = study::load_station_key(study_files.station_file).station;
      station = study_files.station->name;
    }
  } catch (const Error&) {
    return {};  // damaged; `run` reports that
  }
  use_study_of_station(station, study_files);
  return study_files;
}

analysis::StatusSources sources_for(const StatusArguments& arguments,
                                    const StatusFiles& study_files) {
  analysis::StatusSources sources;
  sources.consents = consents_beside(arguments.database);
  sources.has_consents = !sources.consents.empty();
  sources.station = study_files.station;
  if (!study_files.design) return sources;
  sources.planned = study_files.design->registration.participants;
  sources.consent_version = study_files.design->session.consent_version;
  return sources;
}

/// Sentences on the balance of stations and enrolment numbers; none for a single station of
/// several, whose numbers need not start at 1.
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
  std::string earliest{};  ///< earliest time, as text; empty: now
};

/// Whether the planned number of participants has been reached, so that no new one is due.
bool has_all_planned(const analysis::StudyStatus& status) {
  std::set<std::string> participants;
  for (const analysis::PersonStatus& person : status.people) {
    const bool is_planned =
        person.state == "complete" || person.state == "open" || person.state == "stopped";
    if (is_planned) participants.insert(person.participant);
  }
  return status.planned > 0 && static_cast<int>(participants.size()) >= status.planned;
}

/// The next session, in this order: an open one, one of a participant who has consented or replaces
/// another, a visit that is due, or one of a new participant.
std::optional<NextSession> next_session(const analysis::StudyStatus& status) {
  std::vector<std::string> ids;
  for (const analysis::PersonStatus& person : status.people) {
    if (person.can_resume || person.state == "to come") {
      return NextSession{person.participant, person.visit, person.can_resume};
    }
    if (!person.participant.empty()) ids.push_back(person.participant);
  }
  if (!status.upcoming_visits.empty()) {
    const analysis::UpcomingVisit& visit = status.upcoming_visits.front();
    const bool is_due = visit.is_due(utc_now());
    if (is_due || has_all_planned(status)) {
      return NextSession{visit.participant, visit.visit, false,
                         is_due ? "" : utc_words(*visit.from)};
    }
  }
  const std::optional<std::string> id = next_id(ids);
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

std::string run_line(const StatusArguments& arguments, const StatusFiles& study_files,
                     const DatabaseWords& words, const NextSession& next, bool pilot) {
  const std::string study =
      study_files.study.empty() ? "STUDY" : shell_word(study_files.study.string());
  std::string line = "touchtrial run " + study + " --participant " + shell_word(next.participant) +
                     " --db " + shell_word(arguments.database.string());
  const bool is_default =
      study_files.study.empty() || study_files.station_file.empty() ||
      study_files.station_file.lexically_normal() ==
          pack_place_for(study_files.study, {}).station(words.station).lexically_normal();
  if (!is_default) {
    line += " --station-file " + shell_word(study_files.station_file.string());
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
         (next.earliest.empty() ? "" : ", from " + next.earliest);
}

/// Empty if sessions are recorded elsewhere or simulated, or if collection is closed.
std::vector<analysis::NextCommand> next_commands(const StatusArguments& arguments,
                                                 const StatusFiles& study_files,
                                                 const DatabaseWords& words,
                                                 const analysis::StudyStatus& status) {
  const bool is_recording = status.stations == 0 && !status.state.closed && !status.simulated;
  if (!is_recording) return {};
  const std::optional<NextSession> session = next_session(status);
  if (!session) return {};
  const std::string& id = session->participant;
  const bool has_consented =
      std::ranges::any_of(status.people, [&](const analysis::PersonStatus& person) {
        return person.participant == id && !person.consent.empty();
      });
  std::vector<analysis::NextCommand> next;
  if (!has_consented) {
    const std::string version =
        study_files.design && !study_files.design->session.consent_version.empty()
            ? study_files.design->session.consent_version
            : "VERSION";
    next.push_back({"consent of " + id, "touchtrial consent " +
                                            shell_word(arguments.database.string()) +
                                            " --participant " + shell_word(id) + " --version " +
                                            shell_word(version) + " --details -"});
  }
  next.push_back({next_session_text(*session),
                  run_line(arguments, study_files, words, *session, status.pilot)});
  return next;
}

void print_status(const StatusArguments& arguments, const StatusFiles& study_files,
                  const DatabaseWords& words, const analysis::StudyStatus& status) {
  const auto next = next_commands(arguments, study_files, words, status);
  print(arguments.json ? analysis::status_json(status, next) : analysis::status_text(status, next));
}

/// Shows the consents and the first command line before the first session.
int show_status_without_database(const StatusArguments& arguments) {
  const StatusFiles study_files = find_files_without_database(arguments);
  const analysis::StatusSources sources = sources_for(arguments, study_files);
  if (!study_files.design && sources.consents.empty()) {
    throw StoreError(one_line(arguments.database.string()) +
                     ": does not exist, and neither a consent nor a study is beside it; check "
                     "the name, or name the study file with --study");
  }
  DatabaseWords words;
  if (study_files.station) words.station = study_files.station->name;
  print_status(arguments, study_files, words,
               analysis::status_before(
                   study_files.design ? study_files.design->name : "",
                   study_files.design ? study_files.design->protocol_name() : "", sources));
  return 0;
}

int show_status(const StatusArguments& arguments) {
  if (!path_exists(arguments.database)) return show_status_without_database(arguments);
  const record::StudyStore store =
      record::StudyStore::open(arguments.database, record::StudyStore::Access::read_only);
  const StatusFiles study_files = find_files(arguments, store.commitment());
  analysis::StudyStatus status = analysis::status_of(store, sources_for(arguments, study_files));
  status.balance = balance_of(store);
  status.head_fault = analysis::check_heads(store, arguments.database).fault();
  print_status(arguments, study_files, database_words(store), status);
  return status.head_fault.empty() ? 0 : kNotVerified;
}

}  // namespace

void add_status_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "status",
      "Finished and open sessions, remaining work, and the command for the next participant",
      show_status);
  add_database_argument(command, arguments.database);
  command.add_option(
      "--study", arguments.study,
      "Study file (default: that of the station's file beside the database or here)");
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
