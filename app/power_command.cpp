// power: simulates a study many times, in one process or in shards.
#include "analysis/planning/power_progress.hpp"
#include "analysis/planning/power_report.hpp"
#include "analysis/planning/rehearsed_study.hpp"
#include "analysis/planning/stated_people.hpp"
#include "analysis/planning/uncertain_subject.hpp"
#include "analysis/planning/what_if.hpp"
#include "analysis/text_figures.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/force_flag.hpp"
#include "app/power_files.hpp"
#include "app/study_inputs.hpp"
#include "app/threshold_power.hpp"
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
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PowerArguments {
  fs::path study;
  fs::path subject;
  fs::path fit;
  fs::path other;  ///< subject of --what-if
  std::string on;
  fs::path folder;
  std::vector<fs::path> combine;
  std::vector<std::string> methods;
  std::string sizes = "8,12,16,20,30";
  std::optional<double> margin;
  std::string shard;
  bool has_shard = false;
  std::optional<double> effect;
  std::optional<double> mean;
  double sd_between = 0.0;
  std::optional<double> accuracy;
  planning::PowerPlan plan;
  ThresholdPowerArguments of_thresholds;
  std::vector<std::string> given;  ///< the options that were given, by name
  int jobs = 1;
  bool no_early_stop = false;
  bool resume = false;
  bool json = false;
};

/// A digest of the study's stimuli: of every field that may be felt, and of nothing else in the
/// pack.
std::string fields_digest(const design::StudyKey& key, const engine::Pack& pack) {
  FieldHasher hasher;
  for (const design::KeyedStimulus& keyed : key.stimuli) {
    const engine::PackEntry& entry = pack.entry(keyed.code);
    const std::string gains = fmt::format("{} {} {}", entry.gains.tangential_n,
                                          entry.gains.normal_n, entry.gains.height_mm);
    hasher.add(entry.code).add(ByteView(entry.checksum)).add(gains);
  }
  return to_hex(hasher.finish());
}

/// Everything that the runs need.
struct PowerPreparation {
  PowerPreparation(const PowerArguments& arguments, design::Study loaded)
      : study(std::move(loaded)),
        test(test_for(study, arguments)),
        stated(stated_by(arguments, test)),
        fitted(fitted_by(arguments, study)),
        subject(stated   ? simulation::SubjectModel{}
                : fitted ? fitted->subject
                         : subject_for(arguments.subject, study, arguments.on)),
        key(simulated_key(study, arguments.study)) {
    if (stated) return;
    // Shards begin at the same time and share the pack.
    prepare_simulated_pack(key);
    pack.emplace(key.pack_folder);
  }

  static planning::PrimaryTest test_for(const design::Study& study,
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

  static std::optional<planning::UncertainSubject> fitted_by(const PowerArguments& arguments,
                                                             const design::Study& study) {
    if (arguments.fit.empty()) return std::nullopt;
    planning::UncertainSubject fitted = planning::load_uncertain_subject(arguments.fit);
    fitted.subject.check_labels(study);
    for (const simulation::SubjectModel& draw : fitted.draws) draw.check_labels(study);
    return fitted;
  }

  [[nodiscard]] std::string assumed_words() const {
    if (stated) return planning::words_of(*stated);
    return fitted ? planning::words_of(*fitted) : planning::words_of(subject);
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
            assumed_words(),
            std::string(program_version()),
            fitted ? static_cast<int>(fitted->draws.size()) : 0,
            study.trials.order != design::TrialOrder::uniform,
            analysis::device_words(
                {stated ? analysis::kStatedPeople : simulation::recorded_device(subject)})};
  }

  design::Study study;
  planning::PrimaryTest test;
  std::optional<planning::StatedPeople> stated;  ///< then nobody feels, and there is no pack
  std::optional<planning::UncertainSubject> fitted;
  simulation::SubjectModel subject;
  design::StudyKey key;
  std::optional<engine::Pack> pack;
};

std::unique_ptr<const planning::Feelings> feelings_for(const PowerPreparation& prepared,
                                                       const simulation::SubjectModel& subject,
                                                       const planning::PowerPlan& plan, int jobs,
                                                       const simulation::LabelledFields& fields,
                                                       const design::Progress& progress = {}) {
  if (plan.servo) {
    return std::make_unique<planning::ServoFeelings>(fields, prepared.study, subject);
  }
  const planning::BankedFeelingsOptions options{plan.explorations, plan.trainings, plan.seed, jobs};
  return std::make_unique<planning::BankedFeelings>(fields, prepared.study, subject, options,
                                                    progress);
}

fs::path file_of(const PowerArguments& arguments, const planning::Shard& shard) {
  return arguments.has_shard ? shard_file(arguments.folder, shard)
                             : progress_file(arguments.folder);
}

void make_missing_runs(const PowerPreparation& prepared, const PowerArguments& arguments,
                       planning::PowerProgress& progress) {
  std::optional<ProgressKeeper> keeper;
  if (!arguments.folder.empty()) {
    keeper.emplace(file_of(arguments, progress.shard));
    // This finds out now whether the folder can be written; a shard without runs needs a file too.
    keeper->keep(progress);
  }
  if (planning::is_complete(progress)) return;
  planning::PowerWork work{.jobs = arguments.jobs, .progress = progress_bar("simulating")};
  if (keeper) work.keep = [&](const planning::PowerProgress& so_far) { keeper->keep(so_far); };
  const int most = progress.plan.participants.back();
  if (prepared.stated) {
    const planning::StatedRehearsal study(prepared.study, *prepared.stated, prepared.test, most);
    planning::make_runs(study, prepared.test, work, progress);
    return;
  }
  const session::StimulusSource source(*prepared.pack, prepared.key.study.rendering);
  const simulation::LabelledFields fields(prepared.key, source);
  const auto feelings = feelings_for(prepared, prepared.subject, progress.plan, arguments.jobs,
                                     fields, progress_bar("feeling"));
  planning::RehearsalOptions options{.first_half_loss = progress.plan.first_half_loss};
  if (progress.plan.effect != 0.0) options.effect = progress.plan.effect;
  if (prepared.fitted) options.draws = prepared.fitted->draws;
  const planning::RehearsedStudy study(prepared.study, prepared.subject, prepared.test, *feelings,
                                       most, std::move(options));
  planning::make_runs(study, prepared.test, work, progress);
}

void print_shard(const PowerArguments& arguments, const planning::PowerProgress& progress) {
  const fs::path file = file_of(arguments, progress.shard);
  const int runs = progress.shard.own_runs(progress.plan.runs);
  print(analysis::simulated_on_line(progress.setting.device) +
        fmt::format("SIMULATED: shard {}/{}: {} of {} runs of each of {} sizes\nfile     {}\n",
                    progress.shard.number, progress.shard.count, runs, progress.plan.runs,
                    progress.plan.participants.size(), file.string()));
}

int print_report(const PowerArguments& arguments, const planning::PowerProgress& progress) {
  const planning::PowerReport report = planning::make_power_report(progress);
  if (!arguments.folder.empty()) write_power_results(arguments.folder, report);
  print(arguments.json ? planning::power_json(report) : planning::power_text(report));
  return 0;
}

int combine(const PowerArguments& arguments) {
  const planning::CombinedPower all = planning::combined(load_shards(arguments.combine));
  for (const std::string& remark : all.remarks) spdlog::warn("{}", remark);
  if (!arguments.folder.empty()) {
    require_power_places(arguments.folder);
    make_folder(arguments.folder);
  }
  return print_report(arguments, all.progress);
}

/// \throws UsageError if there would be no effect
double require_effect(double effect) {
  if (effect != 0.0) return effect;
  throw UsageError("--effect: 0 is no effect; give another share");
}

int what_if(const PowerArguments& arguments, const PowerPreparation& prepared,
            const planning::PowerPlan& plan) {
  if (plan.participants.size() != 1) {
    throw UsageError("--what-if: is for one size; give it with --participants, for instance 20");
  }
  simulation::SubjectModel other = simulation::load_subject_model(arguments.other);
  other.check_labels(prepared.study);
  const session::StimulusSource source(*prepared.pack, prepared.key.study.rendering);
  const simulation::LabelledFields fields(prepared.key, source);
  const planning::WhatIf result = planning::what_if(
      prepared.study, prepared.test, prepared.subject,
      planning::assumptions_about(prepared.subject, other), plan, prepared.setting(),
      [&](const simulation::SubjectModel& subject) {
        return feelings_for(prepared, subject, plan, arguments.jobs, fields);
      },
      arguments.jobs, progress_bar("assuming"));
  print(arguments.json ? planning::what_if_json(result) : planning::what_if_text(result));
  return 0;
}

/// Options of studies whose thresholds are planned, and those that such studies share with others.
constexpr std::array<std::string_view, 4> kOfThresholds = {"--trials", "--width", "--difference",
                                                           "--pool"};
constexpr std::array<std::string_view, 8> kOfAllProtocols = {
    "STUDY", "--participants", "--runs", "--seed", "--subject", "--on", "--jobs", "--json"};

/// \throws UsageError if an option was given that the study's protocol does not know
void refuse_options_of_others(const design::Study& study, const PowerArguments& arguments) {
  const bool has_thresholds = study.protocol_name() == "threshold";
  for (const std::string& option : arguments.given) {
    const bool is_own = std::ranges::find(kOfThresholds, option) != kOfThresholds.end();
    const bool is_shared = std::ranges::find(kOfAllProtocols, option) != kOfAllProtocols.end();
    if (is_shared || is_own == has_thresholds) continue;
    throw UsageError(
        one_line(fmt::format("{}: {}; leave it out", option,
                             is_own ? "is for studies of the protocol threshold"
                                    : "is not for studies of the protocol threshold")));
  }
}

int power(PowerArguments arguments) {
  if (!arguments.combine.empty()) return combine(arguments);
  if (arguments.study.empty()) {
    throw UsageError("power: STUDY is missing; give a study file, or shards with --combine");
  }
  planning::PowerPlan plan = arguments.plan;
  plan.participants = numbers_named(arguments.sizes, "--participants", "a number of participants");
  if (arguments.effect) plan.effect = require_effect(*arguments.effect);
  plan.stop_early = !arguments.no_early_stop;
  planning::settle(plan);
  const planning::Shard shard =
      arguments.has_shard ? shard_named(arguments.shard) : planning::Shard{};
  design::Study loaded = design::load_study(arguments.study);
  refuse_options_of_others(loaded, arguments);
  if (loaded.protocol_name() == "threshold") {
    return plan_thresholds(loaded, arguments.study,
                           subject_for(arguments.subject, loaded, arguments.on), plan,
                           arguments.of_thresholds, arguments.jobs, arguments.json);
  }
  const PowerPreparation prepared(arguments, std::move(loaded));
  if (plan.effect != 0.0 && prepared.test.margin) {
    throw UsageError(
        "--effect: the study registers a margin, and then power is that for methods that are "
        "alike; leave it out");
  }
  plan.level = prepared.test.alpha;
  plan.margin = prepared.test.margin.value_or(0.0);
  if (!arguments.other.empty()) return what_if(arguments, prepared, plan);
  planning::PowerProgress progress = planning::new_progress(prepared.setting(), plan, shard);
  if (!arguments.folder.empty()) {
    if (!arguments.has_shard) require_power_places(arguments.folder);
    make_folder(arguments.folder);
    progress = taken_up(file_of(arguments, shard), std::move(progress), arguments.resume);
  }
  make_missing_runs(prepared, arguments, progress);
  if (!arguments.has_shard) return print_report(arguments, progress);
  print_shard(arguments, progress);
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
  command
      .add_option("--pool", arguments.pool,
                  "Thresholds: simulated participants from whom samples are drawn")
      ->check(CLI::Range(10, 10'000))
      ->capture_default_str();
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
  CLI::Option* fit =
      command
          .add_option("--fit", arguments.fit,
                      "In place of a subject model: a fit as `fit DB --json` prints it, for the "
                      "assurance over what it leaves open")
          ->type_name("FILE")
          ->excludes(command.get_option("--subject"))
          ->excludes(command.get_option("--on"));
  CLI::Option* other =
      command
          .add_option("--what-if", arguments.other,
                      "Change each assumption alone: other senses, hands and devices, and what "
                      "this other subject file says; with one size of --participants")
          ->type_name("FILE")
          ->excludes(fit);
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
  command.add_flag("--no-early-stop", arguments.no_early_stop,
                   "Make all runs, even if the result is already certain");
  command
      .add_option("--explorations", plan.explorations,
                  "Explorations of each stimulus from which trials draw")
      ->capture_default_str();
  command.add_option("--trainings", plan.trainings, "Trainings from which studies draw")
      ->capture_default_str();
  command
      .add_option("--effect", arguments.effect,
                  "The smallest effect of interest in place of the assumed people's: a mean "
                  "accuracy, or of two methods a difference of accuracies, as a share")
      ->type_name("SHARE")
      ->excludes(command.get_option("--margin"));
  command
      .add_option("--first-half-loss", plan.first_half_loss,
                  "Share of right answers that people miss in the first half of their trials, as "
                  "they learn; 0 to 1")
      ->type_name("SHARE")
      ->capture_default_str();
  command.add_flag(
      "--servo", plan.servo,
      "Run every exploration through the servo, for comparison; some hundred times slower");
  add_threshold_options(command, arguments.of_thresholds);
  command.get_option("--mean")->excludes(fit)->excludes(other);
  other->excludes(command.get_option("--effect"))->excludes(command.get_option("--servo"));
  // They describe people who feel.
  for (const char* option : {"--subject", "--on", "--explorations", "--trainings",
                             "--first-half-loss", "--effect", "--servo"}) {
    command.get_option("--mean")->excludes(command.get_option(option));
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

}  // namespace

void add_power_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<PowerArguments>();
  CLI::App* command = program.add_subcommand(
      "power",
      "Estimate a study's power, type-I error and interval widths by simulating it many times");
  command->add_option("STUDY", arguments->study, "Study file");
  add_plan_options(*command, *arguments);
  const std::vector<CLI::Option*> of_a_run = command->get_options(
      [&](const CLI::Option* option) { return option != command->get_help_ptr(); });
  add_jobs_option(*command, arguments->jobs);
  CLI::Option* folder = command->add_option(
      "-o,--out", arguments->folder,
      "Folder for the progress, and for the results as JSON, CSV, Markdown, SVG and PDF");
  CLI::Option* resume =
      command
          ->add_flag("--resume", arguments->resume, "Continue this run from its progress in --out")
          ->needs(folder);
  CLI::Option* shard =
      command
          ->add_option("--shard", arguments->shard,
                       "Make one part of the runs, for --combine; never stops early")
          ->type_name("I/N")
          ->needs(folder);
  CLI::Option* combine =
      command
          ->add_option("--combine", arguments->combine,
                       "Combine all shards of a run, given as folders or files, instead of a study")
          ->excludes(shard)
          ->excludes(resume);
  CLI::Option* other = command->get_option("--what-if");
  for (CLI::Option* option : {folder, resume, shard}) other->excludes(option);
  add_force_flag(*command);
  // Shards contain their plan.
  for (CLI::Option* option : of_a_run) combine->excludes(option);
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] {
    refuse_empty_values(*command);
    arguments->has_shard = shard->count() > 0;
    for (const CLI::Option* option : command->get_options()) {
      if (option->count() > 0) arguments->given.push_back(option->get_name());
    }
    action = [=] { return power(*arguments); };
  });
}

}  // namespace touchtrial::app
