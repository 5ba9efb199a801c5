#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"
#include "app/command_options.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/enrolment_plan.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PlanArguments {
  fs::path study;
  fs::path output;
  int participants = 0;
  int stations = 0;
  std::vector<std::string> names;
  bool extend = false;
  bool json = false;
};

std::vector<std::string> station_names(const PlanArguments& arguments) {
  if (!arguments.names.empty()) return arguments.names;
  std::vector<std::string> names;
  for (int i = 1; i <= arguments.stations; ++i) names.push_back(std::to_string(i));
  return names;
}

std::string ranges_text(const design::StationShare& share) {
  std::string text;
  for (const design::EnrolmentRange& range : share.ranges) {
    text += (text.empty() ? "" : ", ") + (range.size() == 1
                                              ? std::to_string(range.first)
                                              : fmt::format("{} to {}", range.first, range.last));
  }
  return text;
}

std::string orders_text(const std::vector<int>& counts) {
  return fmt::format("{}", fmt::join(counts, " "));
}

std::string plan_text(const design::Study& study, const design::EnrolmentPlan& plan,
                      const fs::path& path) {
  analysis::TextTable table({"station", "participants", "of each order of methods"});
  std::string numbers;
  for (const design::StationShare& share : plan.stations) {
    table.add({share.station, std::to_string(share.size()),
               orders_text(design::orders_of(study, share.ranges))});
    numbers += analysis::wrapped("  " + share.station + ": ", ranges_text(share));
  }
  const std::vector<design::EnrolmentRange> all = {{1, plan.participants()}};
  table.add(
      {"all", std::to_string(plan.participants()), orders_text(design::orders_of(study, all))});
  return fmt::format(
      "{}: {} at {}\n{}enrolment numbers of each station\n{}plan  {}\nGive every station this file "
      "beside its study file; there, `touchtrial run ... --station NAME` takes its next number.\n",
      plan.study, analysis::counted(plan.participants(), "participant"),
      analysis::counted(static_cast<int>(plan.stations.size()), "station"), table.text(), numbers,
      path.string());
}

std::string plan_json(const design::Study& study, const design::EnrolmentPlan& plan,
                      const fs::path& path) {
  nlohmann::ordered_json stations = nlohmann::ordered_json::array();
  for (const design::StationShare& share : plan.stations) {
    nlohmann::ordered_json ranges = nlohmann::ordered_json::array();
    for (const design::EnrolmentRange& range : share.ranges)
      ranges.push_back({range.first, range.last});
    stations.push_back({{"station", share.station},
                        {"participants", share.size()},
                        {"enrolments", ranges},
                        {"method_orders", design::orders_of(study, share.ranges)}});
  }
  const nlohmann::ordered_json document = {{"study", plan.study},
                                           {"participants", plan.participants()},
                                           {"stations", stations},
                                           {"plan", path.string()}};
  return json_text(document);
}

/// The existing plan with --extend, else an empty one.
design::EnrolmentPlan plan_to_fill(const PlanArguments& arguments, const design::Study& study,
                                   const fs::path& path) {
  if (!arguments.extend) {
    if (is_there(path)) {
      throw UsageError(path.string() +
                       ": exists already, and stations may use it; hand out more numbers with "
                       "--extend, or give another --output");
    }
    return design::empty_plan(study, station_names(arguments));
  }
  if (!is_there(path)) {
    throw UsageError(path.string() +
                     ": does not exist and cannot be extended; make it with --stations or --names");
  }
  design::EnrolmentPlan plan = design::load_plan(path, study);
  if (arguments.participants < plan.participants()) {
    throw UsageError(fmt::format(
        "{}: has numbers for {} participants, which cannot be withdrawn; give --participants {} or "
        "more",
        path.string(), plan.participants(), plan.participants()));
  }
  return plan;
}

int plan_enrolment(const PlanArguments& arguments) {
  if (!arguments.extend && arguments.stations == 0 && arguments.names.empty()) {
    throw UsageError("plan: the stations are missing; give --stations N, or their --names");
  }
  const design::Study study = design::load_study(arguments.study);
  const fs::path path =
      arguments.output.empty() ? design::plan_path_for(arguments.study) : arguments.output;
  design::EnrolmentPlan plan = plan_to_fill(arguments, study, path);
  design::extend_plan(plan, study, arguments.participants);
  design::save_plan(path, plan);
  print(arguments.json ? plan_json(study, plan, path) : plan_text(study, plan, path));
  return 0;
}

}  // namespace

void add_plan_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = program.add_subcommand(
      "plan", "Hand out enrolment numbers to several stations before the first participant comes");
  add_study_argument(*command, arguments->study);
  command->add_option("--participants", arguments->participants, "Number of participants in all")
      ->check(CLI::Range(1, design::kMostPlanned))
      ->required();
  auto* stations = command
                       ->add_option("--stations", arguments->stations,
                                    "Number of stations, which are named 1, 2, and so on")
                       ->check(CLI::Range(1, static_cast<int>(design::kMostStations)));
  auto* names =
      command
          ->add_option("--names", arguments->names, "Names of the stations, instead of --stations")
          ->delimiter(',')
          ->excludes(stations);
  command
      ->add_flag("--extend", arguments->extend,
                 "Add numbers to the existing plan, and keep its own")
      ->excludes(stations)
      ->excludes(names);
  command->add_option("-o,--output", arguments->output,
                      "File to write (default: <study>.plan.json beside the study file)");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return plan_enrolment(*arguments); }; });
}

}  // namespace touchtrial::app
