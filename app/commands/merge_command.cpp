// merge: collects several stations' databases into one.
#include "analysis/report/text_figures.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/merging/bundle_table.hpp"
#include "record/payload_json.hpp"
#include "record/personal_data.hpp"
#include "study/study_key.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct MergeArguments {
  std::vector<fs::path> databases;
  fs::path target;
  bool json = false;
};

void refuse_existing_output(const fs::path& path) {
  if (!is_there(path)) return;
  throw StoreError(one_line(path.string()) + ": exists already; give another name with -o");
}

merging::Stations stations_of(const std::vector<fs::path>& databases) {
  merging::Stations stations;
  for (const fs::path& database : databases) {
    const std::string where = database.string();
    // Anything but a file name may contain a password, and is handled where messages do not repeat
    // it.
    const bool is_on_server = where.find("://") != std::string::npos;
    if (!is_on_server) require_head_beside(database);
    merging::Stations those = is_on_server
                                  ? merging::stations_of_table(merging::open_bundle_table(where))
                                  : merging::stations_of_file(database);
    for (auto& station : those) stations.push_back(std::move(station));
  }
  return stations;
}

/// Copies versions and times of consents from the personal data beside the stations' databases,
/// which is the part that exports use. Existing consents are unchanged.
/// \return the number of consents of the merged database
std::size_t merge_consents(const MergeArguments& arguments) {
  std::vector<record::PersonalRecord> consents;
  for (const fs::path& database : arguments.databases) {
    try {
      for (const record::PersonalRecord& one : consents_beside(database)) {
        consents.push_back({.participant = one.participant,
                            .consent_version = one.consent_version,
                            .consented_utc = one.consented_utc});
      }
    } catch (const Error& error) {
      spdlog::warn("consents are left out: {}", error.what());
    }
  }
  if (consents.empty()) return 0;
  record::PersonalData data(record::personal_data_path(arguments.target));
  std::vector<record::PersonalRecord> known = data.all();
  for (const record::PersonalRecord& one : consents) {
    if (std::ranges::count(known, one) > 0) continue;
    data.put(one);
    known.push_back(one);
  }
  return known.size();
}

/// The key beside one of the databases, if it belongs to a simulated study with this seal.
std::optional<study::StudyKey> simulated_key_beside(const std::vector<fs::path>& databases,
                                                    const Digest& seal) {
  for (const fs::path& database : databases) {
    const fs::path path = key_path_for(database, {});
    if (!is_there(path)) continue;
    study::StudyKey key = study::load_study_key(path);
    if (key.simulated && key.seal == seal) return key;
  }
  return std::nullopt;
}

/// The key to write beside a merged database of simulated participants, as `simulate` does: it is
/// derived from the study file, so it is not secret. The key of a study with people is not copied.
/// \throws StoreError if another key is in its place
std::optional<study::StudyKey> key_to_write(const MergeArguments& arguments,
                                            const merging::Stations& stations) {
  if (stations.empty()) return std::nullopt;
  const std::vector<record::Event> chain = stations.front()->file_chain();
  if (chain.empty()) return std::nullopt;
  const record::StudyCommitment commitment =
      record::from_json<record::StudyCommitment>(chain.front().body);
  if (!commitment.simulated) return std::nullopt;
  std::optional<study::StudyKey> key = simulated_key_beside(arguments.databases, commitment.seal);
  const fs::path path = key_path_for(arguments.target, {});
  if (key && is_there(path) && study::load_study_key(path).seal != commitment.seal) {
    throw StoreError(one_line(path.string()) +
                     ": is the key of another study; give another name with -o, or move it away");
  }
  return key;
}

std::string summary_of(const MergeArguments& arguments, const merging::CollectReport& report,
                       std::size_t consents, bool key) {
  const std::string key_path = key_path_for(arguments.target, {}).string();
  if (!arguments.json) {
    return fmt::format(
        "{}: {} of {}\n{}{}", arguments.target.string(),
        analysis::counted(report.sessions, "session"),
        analysis::counted(report.stations, "station"),
        consents > 0
            ? fmt::format("consents {}\n", record::personal_data_path(arguments.target).string())
            : "",
        key ? "key " + key_path + "\n"
            : "the key of the study stays where it is: name it with --key\n");
  }
  nlohmann::json left_out = nlohmann::json::array();
  for (const merging::SessionLeftOut& session : report.left_out) {
    left_out.push_back({{"station", session.station},
                        {"session", session.session},
                        {"participant", session.participant},
                        {"cut_short", session.cut_short}});
  }
  const nlohmann::json summary = {{"database", arguments.target.string()},
                                  {"stations", report.stations},
                                  {"sessions", report.sessions},
                                  {"left_out", left_out},
                                  {"superfluous", report.redundant},
                                  {"consents", consents},
                                  {"key", key ? nlohmann::json(key_path) : nullptr}};
  return json_text(summary);
}

int merge(const MergeArguments& arguments) {
  if (arguments.target.empty()) throw UsageError("merge: -o is empty; give it a file name");
  refuse_existing_output(arguments.target);
  merging::Stations stations = stations_of(arguments.databases);
  const std::optional<study::StudyKey> key = key_to_write(arguments, stations);
  const merging::CollectReport report =
      merging::collect_into_file(std::move(stations), arguments.target, progress_bar("merging"));
  for (const merging::SessionLeftOut& session : report.left_out)
    spdlog::warn("{}", session.words());
  for (const std::string& name : report.redundant) {
    spdlog::warn("{}", one_line(name + ": has no finished session that the others do not have"));
  }
  if (key) study::save_study_key(key_path_for(arguments.target, {}), *key);
  print(summary_of(arguments, report, merge_consents(arguments), key.has_value()));
  return 0;
}

}  // namespace

void add_merge_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "merge",
                  "Make one database from several stations' databases of one study", merge);
  command
      .add_option("DB", arguments.databases,
                  "Databases of the stations, or the postgresql:// address of a study")
      ->required();
  command
      .add_option("-o,--out", arguments.target,
                  "Database to create; the order of the stations does not matter")
      ->check(place_validator())
      ->required();
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
