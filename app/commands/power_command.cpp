// power: simulates a study many times.
#include "analysis/planning/planner.hpp"
#include "analysis/report/page/report_folder.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PowerArguments {
  fs::path study;
  fs::path subject;
  std::string hand_device;
  std::string sizes = "8,12,16,20,30";
  fs::path figure;  ///< folder of the power curve; empty: no figure
  planning::PowerOptions options;
  const CLI::App* command = nullptr;
};

/// \throws UsageError if an option does not apply to the study's protocol
void refuse_inapplicable_options(const study::Study& study, const PowerArguments& arguments) {
  for (const CLI::Option* cli_option : arguments.command->get_options()) {
    const std::string option = cli_option->get_name();
    const std::vector<std::string_view> protocols = planning::protocols_with(option);
    const bool is_applicable =
        std::ranges::find(protocols, study.protocol_name()) != protocols.end();
    if (cli_option->count() == 0 || protocols.empty() || is_applicable) continue;
    throw UsageError(one_line(fmt::format(
        "{}: is {}for studies of the protocol {}; leave it out", option,
        protocols.size() == 1 ? "" : "not ",
        protocols.size() == 1 ? std::string(protocols.front()) : study.protocol_name())));
  }
}

/// Refuses an empty value, for example from an unset shell variable: it would count as omitted, and
/// change the question.
void refuse_empty_values(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const auto& values = option->results();
    const bool takes_value = option->get_items_expected_max() > 0;
    if (takes_value && std::ranges::find(values, "") != values.end()) {
      throw UsageError(option->get_name() + ": is empty; give a value, or leave the option out");
    }
  }
}

planning::PowerTools tools_for(const study::Study& study, const PowerArguments& arguments) {
  return {[&] { return subject_for(arguments.subject, study, arguments.hand_device); },
          [&] { return simulated_key(study, arguments.study); }, prepare_simulated_pack,
          progress_bar};
}

constexpr const char* kCurveFiles[] = {"power-curve.svg", "power-curve.pdf", "power-curve.csv",
                                       "power-curve.gp",  "power-curve.py",  "power-curve.r"};

void write_curve(const fs::path& folder, const planning::PowerCurve& curve) {
  const analysis::DrawnFigures figures =
      analysis::draw_report_figures({planning::power_figure(curve)});
  make_folder(folder);
  for (const auto& [path, content] : figures.files) {
    write_output(folder / fs::path(path).filename(), content);
  }
  if (!figures.missing.empty()) {
    std::fputs(
        ("touchtrial: warning: power-curve: data and scripts only: " + figures.missing + "\n")
            .c_str(),
        stderr);
  }
}

int power(const PowerArguments& arguments) {
  refuse_empty_values(*arguments.command);
  planning::PowerOptions options = arguments.options;
  options.plan.participants =
      planning::parse_numbers(arguments.sizes, "--participants", "a number of participants");
  planning::validate_plan(options.plan);
  const study::Study study = study::load_study(arguments.study);
  const planning::Planner& planner = planning::planner_of(study, "`power`");
  refuse_inapplicable_options(study, arguments);
  const bool has_figure = !arguments.figure.empty();
  if (has_figure) {
    for (const char* name : kCurveFiles) require_output_path(arguments.figure / name);
  }
  const planning::PowerResult result = planner.power(study, options, tools_for(study, arguments));
  print(result.text);
  if (!has_figure) return 0;
  if (result.curve.series.empty()) {
    throw UsageError("--figure: the study compares no thresholds; give --width for a curve");
  }
  write_curve(arguments.figure, result.curve);
  return 0;
}

void add_population_options(CLI::App& command, planning::PowerOptions& options) {
  CLI::Option* mean = command
                          .add_option("--mean", options.mean,
                                      "Instead of simulated hands: people's mean accuracy, or for "
                                      "two methods the mean difference of their accuracies")
                          ->type_name("SHARE");
  CLI::Option* spread = command
                            .add_option("--sd-between", options.sd_between,
                                        "With --mean: the standard deviation between people")
                            ->type_name("SHARE")
                            ->needs(mean);
  mean->needs(spread);
  command
      .add_option("--accuracy", options.accuracy,
                  "With --mean and two methods: the mean accuracy over both methods")
      ->type_name("SHARE")
      ->needs(mean);
}

void add_threshold_options(CLI::App& command, planning::PowerOptions& options) {
  command
      .add_option("--trials", options.trials,
                  "Thresholds: numbers of trials of a track to try (default: the study's)")
      ->type_name("N,N..");
  command
      .add_option(
          "--width", options.width_db,
          "Thresholds: print how often the half-width of a mean's 95 % interval is at most this")
      ->check(finite_range(0.001, 100.0))
      ->type_name("DB");
  command
      .add_option("--difference", options.difference,
                  "Thresholds: the two to compare, first minus second, by their order in the study "
                  "(default: 1,2)")
      ->type_name("N,N");
  add_count_option(command, "--pool", options.pool,
                   "Thresholds, ratings: simulated participants from whom samples are drawn", 10,
                   10'000);
}

void add_plan_options(CLI::App& command, PowerArguments& arguments) {
  planning::PowerOptions& options = arguments.options;
  planning::PowerPlan& plan = options.plan;
  command
      .add_option("--participants", arguments.sizes,
                  "Numbers of participants to try, 2 to 10000 each")
      ->type_name("N,N..")
      ->capture_default_str();
  command
      .add_option("--runs", plan.runs,
                  "Simulated studies of each size, and the same number under the null hypothesis")
      ->capture_default_str();
  add_seed_option(command, plan.seed, "Seed of all random numbers");
  add_subject_option(command, arguments.subject);
  add_on_option(command, arguments.hand_device);
  add_population_options(command, options);
  command
      .add_option(
          "--methods", options.methods,
          "The two methods to test, as A,B (default: the study's two; of ratings, the first two)")
      ->delimiter(',');
  command
      .add_option("--margin", options.margin,
                  "Test non-inferiority instead of the registered question: the first method's "
                  "accuracy is worse by less than this (0.07: 7 points)")
      ->type_name("SHARE");
  command
      .add_option("--explorations", plan.explorations,
                  "Simulated explorations of each stimulus, from which trials are drawn")
      ->capture_default_str();
  command
      .add_option("--trainings", plan.trainings,
                  "Training runs of the simulated people, from which studies are drawn")
      ->capture_default_str();
  add_threshold_options(command, options);
  // The options describe simulated hands.
  for (const char* option : {"--subject", "--on", "--explorations", "--trainings"}) {
    command.get_option("--mean")->excludes(command.get_option(option));
  }
}

}  // namespace

void add_power_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "power",
      "Estimate a study's power, type-I error and interval widths by simulating it many times",
      power);
  arguments.command = &command;
  add_study_argument(command, arguments.study);
  add_plan_options(command, arguments);
  command
      .add_option(
          "--figure", arguments.figure,
          "Folder for the power curve: power-curve.svg and .pdf, its data, and scripts that "
          "redraw it")
      ->type_name("DIR");
  add_jobs_option(command, arguments.options.jobs);
  add_force_flag(command);
  add_json_flag(command, arguments.options.json);
}

}  // namespace touchtrial::app
