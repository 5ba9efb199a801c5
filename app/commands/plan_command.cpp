// plan: divides the participants of a study between its stations.
#include "analysis/report/text_figures.hpp"
#include "analysis/report/text_table.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "study/prepare.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PlanArguments {
  fs::path study;
  fs::path pack;
  int participants = 0;
  int stations = 0;
  std::vector<std::string> names;
  bool extend = false;
  bool groups = false;
  bool json = false;
};

std::vector<std::string> station_names(const PlanArguments& arguments) {
  if (!arguments.names.empty()) return arguments.names;
  std::vector<std::string> names;
  for (int i = 1; i <= arguments.stations; ++i) names.push_back(std::to_string(i));
  return names;
}

std::string ranges_text(const study::Station& station) {
  return listed(station.ranges, ", ", [](const study::EnrolmentRange& range) {
    return range.size() == 1 ? std::to_string(range.first)
                             : fmt::format("{} to {}", range.first, range.last);
  });
}

std::string plan_text(const study::StudyKey& key, const study::PackPlace& place) {
  std::string text =
      fmt::format("{}: {} at {}\n", key.study.name,
                  analysis::counted(study::enrolment_count(key.stations), "participant"),
                  analysis::counted(static_cast<int>(key.stations.size()), "station"));
  for (const study::Station& station : key.stations) {
    text += analysis::wrapped(
        "  " + station.name + ": ",
        fmt::format("{} participants, numbers {}", station.size(), ranges_text(station)));
    text += "    " + place.station(station.name).string() + "\n";
  }
  return text +
         "Put only a station's own file beside its study file; `touchtrial run ... --station "
         "NAME`\n"
         "then uses the station's next number.\n";
}

std::string plan_json(const study::StudyKey& key, const study::PackPlace& place) {
  nlohmann::ordered_json stations = nlohmann::ordered_json::array();
  for (const study::Station& station : key.stations) {
    nlohmann::ordered_json ranges = nlohmann::ordered_json::array();
    for (const study::EnrolmentRange& range : station.ranges)
      ranges.push_back({range.first, range.last});
    stations.push_back({{"station", station.name},
                        {"participants", station.size()},
                        {"enrolments", ranges},
                        {"file", place.station(station.name).string()}});
  }
  const nlohmann::ordered_json document = {{"study", key.study.name},
                                           {"participants", study::enrolment_count(key.stations)},
                                           {"stations", stations}};
  return json_text(document);
}

/// The group of every number up to `participants`, for the person who gives participants their
/// treatment.
std::string groups_text(const study::StudyKey& key, int participants, bool json) {
  const std::vector<std::string>& labels = key.study.groups.labels;
  if (labels.empty()) throw UsageError("plan: the study has no groups; leave --groups out");
  nlohmann::ordered_json assignments = nlohmann::ordered_json::array();
  std::string text;
  for (int number = 1; number <= participants; ++number) {
    const auto group = key.group_of(number, study::Draws::people);
    if (!group) continue;
    const std::string& label = labels[static_cast<std::size_t>(*group)];
    assignments.push_back({{"enrolment", number}, {"group", label}});
    text += fmt::format("{:>7}  {}\n", number, label);
  }
  if (json) {
    const nlohmann::ordered_json document = {{"study", key.study.name}, {"groups", assignments}};
    return json_text(document);
  }
  return fmt::format("{}\n number  group\n{}", key.study.name, text) +
         (key.study.groups.open ? "" : "Keep this secret from people who run sessions.\n");
}

bool is_divided(const study::StudyKey& key) {
  return key.stations.size() > 1 || key.stations.front().name != study::kOnlyStation;
}

/// The key's stations with --extend, otherwise new ones.
std::vector<study::Station> stations_to_fill(const PlanArguments& arguments,
                                             const study::StudyKey& key, const fs::path& path) {
  if (!arguments.extend) {
    if (is_divided(key)) {
      throw UsageError(path.string() +
                       ": the study is divided between stations already, which may use their "
                       "numbers; add more with --extend");
    }
    return study::stations_named(station_names(arguments));
  }
  if (!is_divided(key)) {
    throw UsageError(path.string() +
                     ": the study is not divided between stations; do that with --stations or "
                     "--names");
  }
  const int assigned_count = study::enrolment_count(key.stations);
  if (arguments.participants < assigned_count) {
    throw UsageError(fmt::format(
        "{}: already assigns {} enrolment numbers, which cannot be revoked; give --participants {} "
        "or more",
        path.string(), assigned_count, assigned_count));
  }
  return key.stations;
}

int plan_enrolment(const PlanArguments& arguments) {
  const bool divides_study = arguments.extend || arguments.stations > 0 || !arguments.names.empty();
  if (!divides_study && !arguments.groups) {
    throw UsageError("plan: the stations are missing; give --stations N, or their --names");
  }
  const study::Study study = study::load_study(arguments.study);
  const study::PackPlace place = pack_place_for(arguments.study, arguments.pack);
  if (!path_exists(place.key)) {
    throw FileError(place.key.string() +
                    ": the key does not exist here, and a plan needs it; use the machine that has "
                    "it, or for a new study run `touchtrial prepare` first");
  }
  std::optional<study::PackLock> lock;
  if (divides_study && path_exists(place.pack)) lock.emplace(place.pack);
  study::StudyKey key = study::load_study_key(place.key);
  if (arguments.groups) {
    print(groups_text(key, arguments.participants, arguments.json));
    return 0;
  }
  std::vector<study::Station> stations = stations_to_fill(arguments, key, place.key);
  study::assign_enrolments(stations, arguments.participants);
  if (stations.size() > 1 && study.registration.analysis &&
      !study.registration.analysis->looks.empty()) {
    spdlog::warn("{}", one_line(arguments.study.string() +
                                ": the registration has interim looks, which a study of several "
                                "stations cannot make; remove them and prepare again; otherwise "
                                "the study ends at its planned number of participants"));
  }
  study::assign_stations(key, std::move(stations));
  study::save_study_key(place.key, key);
  save_station_files(key, place);
  // Removes the undivided study's file, whose schedules belong to no station now.
  fs::remove(place.station());
  print(arguments.json ? plan_json(key, place) : plan_text(key, place));
  return 0;
}

}  // namespace

void add_plan_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "plan",
      "Divide a prepared study between stations, before the first participant", plan_enrolment);
  add_study_argument(command, arguments.study);
  command.add_option("--participants", arguments.participants, "Total number of participants")
      ->check(CLI::Range(1, study::kMaxEnrolments))
      ->required();
  auto* stations = command
                       .add_option("--stations", arguments.stations,
                                   "Number of stations, which are named 1, 2, and so on")
                       ->check(CLI::Range(1, static_cast<int>(study::kMaxStations)));
  auto* names =
      command
          .add_option("--names", arguments.names, "Names of the stations, instead of --stations")
          ->delimiter(',')
          ->excludes(stations);
  command
      .add_flag("--extend", arguments.extend,
                "Add numbers to the existing plan, without changing it")
      ->excludes(stations)
      ->excludes(names);
  command
      .add_flag("--groups", arguments.groups,
                "Show which number is in which group, instead of dividing the study")
      ->excludes(stations)
      ->excludes(names)
      ->excludes("--extend");
  add_pack_option(command, arguments.pack);
  add_passphrase_option(command);
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
