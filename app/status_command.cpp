// status: how collection stands, and the command line of the next participant.
#include "analysis/study_status.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/participant_ids.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/collect/collect.hpp"
#include "protocols/collect/enrolment_balance.hpp"
#include "protocols/collect/server_address.hpp"
#include "protocols/design/key_protection.hpp"
#include "protocols/design/prepare.hpp"
#include "protocols/store/personal_data.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
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

/// What lies beside a database: the study file and the station's file, as far as they are there.
struct FilesBeside {
  fs::path study;
  std::optional<design::Study> design;
  fs::path station_file;
  std::optional<design::Station> station;  ///< empty also if a passphrase protects the file
};

/// The station's file, if it is the database's. Never asks for a passphrase.
void take_station_file(const fs::path& file, const store::StudyCommitment& commitment,
                       FilesBeside& beside) {
  if (!commitment.station || !is_there(file)) return;
  try {
    if (const auto signer = design::signer_in_clear(file)) {
      if (*signer == commitment.station->key) beside.station_file = file;
      return;
    }
    const design::StationKey key = design::load_station_key(file);
    if (key.signer().public_half() != commitment.station->key) return;
    beside.station_file = file;
    beside.station = key.station;
  } catch (const Error&) {
    // Another study's, or damaged: `run` says so when it is used.
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

FilesBeside files_beside(const StatusArguments& arguments,
                         const store::StudyCommitment& commitment) {
  FilesBeside beside;
  const std::string station = commitment.station ? commitment.station->name : "";
  if (!arguments.study.empty()) {
    beside.study = arguments.study;
    beside.design = design::load_study(arguments.study);
    if (beside.design->name != commitment.study) {
      throw StudyError(arguments.study.string() + ": is the study " + beside.design->name +
                       ", and the database is of " + one_line(commitment.study) +
                       "; name its study file with --study");
    }
    take_station_file(pack_place_for(arguments.study, {}).station(station), commitment, beside);
    return beside;
  }
  if (!commitment.station || commitment.simulated) return beside;
  for (const fs::path& folder : {arguments.database.parent_path(), fs::path(".")}) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
      if (!beside.station_file.empty() || entry.path().extension() != ".station") continue;
      take_station_file(entry.path().lexically_normal(), commitment, beside);
    }
  }
  if (beside.station_file.empty()) return beside;
  const fs::path study = study_file_of(beside.station_file, station);
  if (!is_there(study)) return beside;
  try {
    beside.design = design::load_study(study);
    beside.study = study;
  } catch (const Error&) {
    // Edited since: `run` says so.
  }
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

/// Sentences on stations and enrolment numbers. A station's own numbers need not begin at 1.
std::vector<std::string> balance_of(const store::StudyStore& store) {
  const store::StudyCommitment& commitment = store.commitment();
  if (commitment.station && commitment.station->name != design::kOnlyStation) return {};
  std::vector<collect::EnrolledSession> sessions;
  for (const store::SessionRow& row : store.sessions()) {
    sessions.push_back({.station = std::max(row.station, 1),
                        .enrolment = row.enrolment,
                        .state = row.state,
                        .counts = !row.excluded && !row.withdrawn && row.replaced_by.empty()});
  }
  return collect::imbalances(collect::enrolment_balance(sessions));
}

/// Who comes next: an open session's participant, one who is to come, or a new id.
std::optional<std::string> next_participant(const analysis::StudyStatus& status) {
  std::vector<std::string> known;
  for (const analysis::PersonStatus& one : status.people) {
    if (one.may_go_on || one.state == "to come") return one.participant;
    if (!one.participant.empty()) known.push_back(one.participant);
  }
  return next_id(known);
}

std::string run_line(const StatusArguments& arguments, const FilesBeside& beside,
                     const store::StudyStore& store, const std::string& participant, bool is_open) {
  const store::StudyCommitment& commitment = store.commitment();
  const std::string study = beside.study.empty() ? "STUDY" : shell_word(beside.study.string());
  std::string line = "touchtrial run " + study + " --participant " + shell_word(participant) +
                     " --db " + shell_word(arguments.database.string());
  const std::string station = commitment.station ? commitment.station->name : "";
  const bool is_usual = beside.study.empty() || beside.station_file.empty() ||
                        beside.station_file.lexically_normal() ==
                            pack_place_for(beside.study, {}).station(station).lexically_normal();
  if (!is_usual) {
    line += " --station-file " + shell_word(beside.station_file.string());
  } else if (station != design::kOnlyStation) {
    line += " --station " + shell_word(station);
  }
  const std::vector<store::SessionRow> rows = store.sessions();
  if (!rows.empty() && !rows.back().device.empty()) line += " --device " + rows.back().device;
  if (commitment.pilot) line += " --pilot";
  return line + (is_open ? " --on-existing resume" : "");
}

/// Nothing where sessions are recorded elsewhere, or by a program, or no more.
std::vector<analysis::NextCommand> next_commands(const StatusArguments& arguments,
                                                 const FilesBeside& beside,
                                                 const store::StudyStore& store,
                                                 const analysis::StudyStatus& status) {
  const bool records = status.stations == 0 && !status.state.closed && !status.simulated &&
                       !collect::is_address(arguments.database.string());
  if (!records) return {};
  const std::optional<std::string> id = next_participant(status);
  if (!id) return {};
  const auto person = std::ranges::find(status.people, *id, &analysis::PersonStatus::participant);
  const bool is_known = person != status.people.end();
  const bool is_open = std::ranges::any_of(status.people, [&](const analysis::PersonStatus& one) {
    return one.participant == *id && one.may_go_on;
  });
  std::vector<analysis::NextCommand> next;
  if (!is_known || person->consent.empty()) {
    const std::string version = beside.design && !beside.design->session.consent_version.empty()
                                    ? beside.design->session.consent_version
                                    : "VERSION";
    next.push_back({"consent of " + *id, "touchtrial consent " +
                                             shell_word(arguments.database.string()) +
                                             " --participant " + shell_word(*id) + " --version " +
                                             shell_word(version) + " --details -"});
  }
  next.push_back({is_open ? "resume the session of " + *id : "session of " + *id,
                  run_line(arguments, beside, store, *id, is_open)});
  return next;
}

int show_status(const StatusArguments& arguments) {
  const store::StudyStore store = collect::open_study(arguments.database.string());
  const FilesBeside beside = files_beside(arguments, store.commitment());
  analysis::StudyStatus status = analysis::status_of(store, sources_for(arguments, beside));
  status.balance = balance_of(store);
  const auto next = next_commands(arguments, beside, store, status);
  print(arguments.json ? analysis::status_json(status, next) : analysis::status_text(status, next));
  return 0;
}

}  // namespace

void add_status_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<StatusArguments>();
  CLI::App* command = program.add_subcommand(
      "status", "Who is done, who is open, what is left to do, and the next participant's command");
  add_study_place_argument(*command, arguments->database);
  command->add_option("--study", arguments->study,
                      "Study file (default: the one of the station's file beside the database or "
                      "here)");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return show_status(*arguments); }; });
}

}  // namespace touchtrial::app
