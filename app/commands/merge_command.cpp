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
  if (!path_exists(path)) return;
  throw StoreError(one_line(path.string()) + ": exists already; give another name with -o");
}

merging::Stations open_stations(const std::vector<fs::path>& databases) {
  merging::Stations stations;
  for (const fs::path& database : databases) {
    const std::string location = database.string();
    // An address may contain a password, so it is opened by code whose messages do not repeat it.
    const bool is_on_server = location.find("://") != std::string::npos;
    if (!is_on_server) check_against_heads(database);
    merging::Stations new_stations =
        is_on_server ? merging::stations_of_table(merging::open_bundle_table(location))
                     : merging::stations_of_file(database);
    for (auto& station : new_stations) stations.push_back(std::move(station));
  }
  return stations;
}

/// Copies the versions and times of consents from the personal data beside the stations' databases;
/// exports need no more. Existing consents are unchanged.
/// \return the number of consents of the merged database
std::size_t merge_consents(const MergeArguments& arguments) {
  std::vector<record::PersonalRecord> consents;
  for (const fs::path& database : arguments.databases) {
    try {
      for (const record::PersonalRecord& consent : consents_beside(database)) {
        consents.push_back({.participant = consent.participant,
                            .consent_version = consent.consent_version,
                            .consented_utc = consent.consented_utc});
      }
    } catch (const Error& error) {
      spdlog::warn("consents are left out: {}", error.what());
    }
  }
  if (consents.empty()) return 0;
  record::PersonalData data(record::personal_data_path(arguments.target));
  std::vector<record::PersonalRecord> merged = data.all();
  for (const record::PersonalRecord& consent : consents) {
    if (std::ranges::count(merged, consent) > 0) continue;
    data.put(consent);
    merged.push_back(consent);
  }
  return merged.size();
}

/// The key beside one of the databases, if it belongs to a simulated study with this seal.
std::optional<study::StudyKey> simulated_key_beside(const std::vector<fs::path>& databases,
                                                    const Digest& seal) {
  for (const fs::path& database : databases) {
    const fs::path path = key_path_for(database, {});
    if (!path_exists(path)) continue;
    study::StudyKey key = study::load_study_key(path);
    if (key.simulated && key.seal == seal) return key;
  }
  return std::nullopt;
}

/// The key to write beside a merged database of simulated participants, which is derived from the
/// study file and thus not secret. The key of a study with people is not copied.
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
  if (key && path_exists(path) && study::load_study_key(path).seal != commitment.seal) {
    throw StoreError(one_line(path.string()) +
                     ": is the key of another study; give another name with -o, or move it away");
  }
  return key;
}

std::string summary_of(const MergeArguments& arguments, const merging::CollectReport& report,
                       std::size_t consents, bool has_key) {
  const std::string key_path = key_path_for(arguments.target, {}).string();
  if (!arguments.json) {
    return fmt::format(
        "{}: {} of {}\n{}{}", arguments.target.string(),
        analysis::counted(report.sessions, "session"),
        analysis::counted(report.stations, "station"),
        consents > 0
            ? fmt::format("consents {}\n", record::personal_data_path(arguments.target).string())
            : "",
        has_key ? "key " + key_path + "\n" : "the study's key is not copied: name it with --key\n");
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
                                  {"key", has_key ? nlohmann::json(key_path) : nullptr}};
  return json_text(summary);
}

int merge(const MergeArguments& arguments) {
  if (arguments.target.empty()) throw UsageError("merge: -o is empty; give it a file name");
  refuse_existing_output(arguments.target);
  merging::Stations stations = open_stations(arguments.databases);
  const std::optional<study::StudyKey> key = key_to_write(arguments, stations);
  const merging::CollectReport report =
      merging::collect_into_file(std::move(stations), arguments.target, progress_bar("merging"));
  for (const merging::SessionLeftOut& session : report.left_out)
    spdlog::warn("{}", session.words());
  for (const std::string& name : report.redundant) {
    spdlog::warn("{}",
                 one_line(name + ": adds no finished session to those of the other databases"));
  }
  if (key) study::save_study_key(key_path_for(arguments.target, {}), *key);
  print(summary_of(arguments, report, merge_consents(arguments), key.has_value()));
  return 0;
}

}  // namespace

void add_merge_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "merge", "Merge the databases of a study's stations into one", merge);
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
