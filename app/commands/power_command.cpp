// power: simulates a study many times.
#include "analysis/planning/power_report.hpp"
#include "analysis/planning/power_runs.hpp"
#include "analysis/planning/rehearsed_study.hpp"
#include "analysis/planning/stated_people.hpp"
#include "analysis/report/text_figures.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/commands/threshold_power.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/text.hpp"
#include "core/version.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PowerArguments {
  fs::path study;
  fs::path subject;
  std::string on;
  std::vector<std::string> methods;
  std::string sizes = "8,12,16,20,30";
  std::optional<double> margin;
  std::optional<double> mean;
  double sd_between = 0.0;
  std::optional<double> accuracy;
  planning::PowerPlan plan;
  ThresholdPowerArguments of_thresholds;
  const CLI::App* command = nullptr;
  int jobs = 1;
  bool json = false;
};

/// A digest of the study's stimuli: of every field that may be felt, and of nothing else in the
/// pack.
std::string fields_digest(const study::StudyKey& key, const engine::Pack& pack) {
  FieldHasher hasher;
  for (const study::KeyedStimulus& keyed : key.stimuli) {
    const engine::PackEntry& entry = pack.entry(keyed.code);
    const std::string gains = fmt::format("{} {} {}", entry.gains.tangential_n,
                                          entry.gains.normal_n, entry.gains.height_mm);
    hasher.add(entry.code).add(ByteView(entry.checksum)).add(gains);
  }
  return to_hex(hasher.finish());
}

/// Everything that the runs need.
struct PowerPreparation {
  PowerPreparation(const PowerArguments& arguments, study::Study loaded)
      : study(std::move(loaded)),
        test(test_for(study, arguments)),
        stated(stated_by(arguments, test)),
        subject(stated ? simulation::SubjectModel{}
                       : subject_for(arguments.subject, study, arguments.on)),
        key(simulated_key(study, arguments.study)) {
    if (stated) return;
    prepare_simulated_pack(key);
    pack.emplace(key.pack_folder);
  }

  static planning::PrimaryTest test_for(const study::Study& study,
                                        const PowerArguments& arguments) {
    const planning::PrimaryTest test = planning::primary_test_of(study, labels(arguments));
    return arguments.margin ? planning::with_margin(test, *arguments.margin) : test;
  }

  static std::optional<planning::StatedPeople> stated_by(const PowerArguments& arguments,
                                                         const planning::PrimaryTest& test) {
    if (!arguments.mean) return std::nullopt;
    const planning::StatedPeople people{*arguments.mean, arguments.sd_between, arguments.accuracy};
    planning::require_possible(people, test);
    return people;
  }

  static std::optional<planning::MethodLabels> labels(const PowerArguments& arguments) {
    if (arguments.methods.empty()) return std::nullopt;
    if (arguments.methods.size() == 2)
      return planning::MethodLabels{arguments.methods[0], arguments.methods[1]};
    throw UsageError("--methods: give two methods, as --methods adaptive,tv-gabor");
  }

  [[nodiscard]] planning::PowerSetting setting() const {
    return {study.name,
            study.protocol_name(),
            planning::words_of(test, study),
            planning::estimate_words(test),
            to_hex(key.seal),
            pack ? fields_digest(key, *pack) : std::string(planning::kNoFields),
            stated ? planning::words_of(*stated) : planning::words_of(subject),
            std::string(program_version()),
            study.trials.order != study::TrialOrder::uniform,
            analysis::device_words(
                {stated ? analysis::kStatedPeople : simulation::recorded_device(subject)})};
  }

  study::Study study;
  planning::PrimaryTest test;
  std::optional<planning::StatedPeople> stated;  ///< then nobody feels, and there is no pack
  simulation::SubjectModel subject;
  study::StudyKey key;
  std::optional<engine::Pack> pack;
};

std::unique_ptr<const planning::Feelings> feelings_for(const PowerPreparation& prepared,
                                                       const planning::PowerPlan& plan, int jobs,
                                                       const simulation::LabelledFields& fields) {
  const planning::BankedFeelingsOptions options{plan.explorations, plan.trainings, plan.seed, jobs};
  return std::make_unique<planning::BankedFeelings>(fields, prepared.study, prepared.subject,
                                                    options, progress_bar("feeling"));
}

planning::PowerRuns made_runs(const PowerPreparation& prepared, const planning::PowerPlan& plan,
                              int jobs) {
  const auto bar = progress_bar("simulating");
  const int largest = plan.participants.back();
  if (prepared.stated) {
    const planning::StatedRehearsal study(prepared.study, *prepared.stated, prepared.test, largest);
    return planning::make_runs(study, prepared.test, prepared.setting(), plan, jobs, bar);
  }
  const session::StimulusSource source(*prepared.pack, prepared.key.study.rendering);
  const simulation::LabelledFields fields(prepared.key, source);
  const auto feelings = feelings_for(prepared, plan, jobs, fields);
  const planning::RehearsedStudy study(prepared.study, prepared.subject, prepared.test, *feelings,
                                       largest);
  return planning::make_runs(study, prepared.test, prepared.setting(), plan, jobs, bar);
}

/// Options of studies whose thresholds are planned, and those that such studies share with others.
constexpr std::array<std::string_view, 4> kOfThresholds = {"--trials", "--width", "--difference",
                                                           "--pool"};
constexpr std::array<std::string_view, 8> kOfAllProtocols = {
    "STUDY", "--participants", "--runs", "--seed", "--subject", "--on", "--jobs", "--json"};

/// \throws UsageError if an option was given that the study's protocol does not know
void refuse_options_of_others(const study::Study& study, const PowerArguments& arguments) {
  const bool has_thresholds = study.protocol_name() == "threshold";
  for (const CLI::Option* given : arguments.command->get_options()) {
    const std::string option = given->get_name();
    const bool is_own = std::ranges::find(kOfThresholds, option) != kOfThresholds.end();
    const bool is_shared = std::ranges::find(kOfAllProtocols, option) != kOfAllProtocols.end();
    if (given->count() == 0 || is_shared || is_own == has_thresholds) continue;
    throw UsageError(
        one_line(fmt::format("{}: {}; leave it out", option,
                             is_own ? "is for studies of the protocol threshold"
                                    : "is not for studies of the protocol threshold")));
  }
}

/// Refuses a value that is empty, as an unset variable of a shell makes it: it would count as left
/// out, and the numbers be those of another question.
void refuse_empty_values(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const auto& values = option->results();
    const bool takes_value = option->get_items_expected_max() > 0;
    if (takes_value && std::ranges::find(values, "") != values.end()) {
      throw UsageError(option->get_name() + ": is empty; give a value, or leave the option out");
    }
  }
}

int power(const PowerArguments& arguments) {
  refuse_empty_values(*arguments.command);
  planning::PowerPlan plan = arguments.plan;
  plan.participants = numbers_named(arguments.sizes, "--participants", "a number of participants");
  planning::settle(plan);
  study::Study loaded = study::load_study(arguments.study);
  refuse_options_of_others(loaded, arguments);
  if (loaded.protocol_name() == "threshold") {
    return plan_thresholds(loaded, arguments.study,
                           subject_for(arguments.subject, loaded, arguments.on), plan,
                           arguments.of_thresholds, arguments.jobs, arguments.json);
  }
  const PowerPreparation prepared(arguments, std::move(loaded));
  plan.level = prepared.test.alpha;
  plan.margin = prepared.test.margin.value_or(0.0);
  const planning::PowerReport report =
      planning::make_power_report(made_runs(prepared, plan, arguments.jobs));
  print(arguments.json ? planning::power_json(report) : planning::power_text(report));
  return 0;
}

void add_stated_options(CLI::App& command, PowerArguments& arguments) {
  CLI::Option* mean =
      command
          .add_option("--mean", arguments.mean,
                      "In place of a simulated hand: people's mean accuracy, or of two methods "
                      "their mean difference of accuracies")
          ->type_name("SHARE");
  CLI::Option* spread = command
                            .add_option("--sd-between", arguments.sd_between,
                                        "With --mean: the standard deviation between people")
                            ->type_name("SHARE")
                            ->needs(mean);
  mean->needs(spread);
  command
      .add_option("--accuracy", arguments.accuracy,
                  "With --mean of two methods: everybody's accuracy, the mean of both")
      ->type_name("SHARE")
      ->needs(mean);
}

void add_threshold_options(CLI::App& command, ThresholdPowerArguments& arguments) {
  command
      .add_option("--trials", arguments.trials,
                  "Thresholds: numbers of trials of a track to try (default: the study's)")
      ->type_name("N,N..");
  command
      .add_option("--width", arguments.width_db,
                  "Thresholds: how often the half-width of a mean's 95 % interval is at most so "
                  "much")
      ->check(finite_range(0.001, 100.0))
      ->type_name("DB");
  command
      .add_option(
          "--difference", arguments.difference,
          "Thresholds: which two to compare, first minus second, by their order in the study "
          "(default: 1,2)")
      ->type_name("N,N");
  add_count_option(command, "--pool", arguments.pool,
                   "Thresholds: simulated participants from whom samples are drawn", 10, 10'000);
}

void add_plan_options(CLI::App& command, PowerArguments& arguments) {
  planning::PowerPlan& plan = arguments.plan;
  command
      .add_option("--participants", arguments.sizes,
                  "Numbers of participants to try, 2 to 10000 each")
      ->type_name("N,N..")
      ->capture_default_str();
  command
      .add_option("--runs", plan.runs,
                  "Simulated studies of each size, and the same number under the null hypothesis")
      ->capture_default_str();
  add_seed_option(command, plan.seed, "Seed of everything random");
  add_subject_option(command, arguments.subject);
  add_on_option(command, arguments.on);
  add_stated_options(command, arguments);
  command
      .add_option("--methods", arguments.methods,
                  "The two methods to test, as A,B, if a comparison has more than two")
      ->delimiter(',');
  command
      .add_option("--margin", arguments.margin,
                  "Test whether the first method is as good: worse by less than this difference of "
                  "accuracies (0.07: 7 points), in place of the registered question")
      ->type_name("SHARE");
  command
      .add_option("--explorations", plan.explorations,
                  "Explorations of each stimulus from which trials draw")
      ->capture_default_str();
  command.add_option("--trainings", plan.trainings, "Trainings from which studies draw")
      ->capture_default_str();
  add_threshold_options(command, arguments.of_thresholds);
  // They describe people who feel.
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
  add_jobs_option(command, arguments.jobs);
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
