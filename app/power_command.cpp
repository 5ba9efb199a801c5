// power: simulates a study many times, in one process or in shards.
#include "analysis/planning/power_progress.hpp"
#include "analysis/planning/power_report.hpp"
#include "analysis/planning/rehearsed_study.hpp"
#include "app/command_options.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/power_files.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/version.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PowerArguments {
  fs::path study;
  fs::path subject;
  fs::path folder;
  std::vector<fs::path> combine;
  std::vector<std::string> methods;
  std::string sizes = "8,12,16,20,30";
  std::string shard;
  bool has_shard = false;
  planning::PowerPlan plan;
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
        test(planning::primary_test_of(study, labels(arguments))),
        subject(subject_for(arguments.subject, study)),
        key(simulated_key(study, arguments.study)) {
    // Shards begin at the same time and share the pack.
    prepare_simulated_pack(key, true);
    pack.emplace(key.pack_folder);
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
            to_hex(design::study_seal(key)),
            fields_digest(key, *pack),
            planning::words_of(subject),
            std::string(program_version()),
            study.trials.order != design::TrialOrder::uniform};
  }

  design::Study study;
  planning::PrimaryTest test;
  simulation::SubjectModel subject;
  design::StudyKey key;
  std::optional<engine::Pack> pack;
};

std::unique_ptr<const planning::Feelings> feelings_for(const PowerPreparation& prepared,
                                                       const planning::PowerPlan& plan, int jobs,
                                                       const simulation::LabelledFields& fields) {
  if (plan.servo) {
    return std::make_unique<planning::ServoFeelings>(fields, prepared.study, prepared.subject);
  }
  const planning::BankedFeelingsOptions options{plan.explorations, plan.trainings, plan.seed, jobs};
  return std::make_unique<planning::BankedFeelings>(fields, prepared.study, prepared.subject,
                                                    options, progress_bar("feeling"));
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
  const session::StimulusSource source(*prepared.pack, prepared.key.study.rendering);
  const simulation::LabelledFields fields(prepared.key, source);
  const auto feelings = feelings_for(prepared, progress.plan, arguments.jobs, fields);
  const planning::RehearsedStudy study(prepared.study, prepared.subject, prepared.test, *feelings,
                                       progress.plan.participants.back());
  planning::PowerWork work{.jobs = arguments.jobs, .progress = progress_bar("simulating")};
  if (keeper) work.keep = [&](const planning::PowerProgress& so_far) { keeper->keep(so_far); };
  planning::make_runs(study, prepared.test, work, progress);
}

void print_shard(const PowerArguments& arguments, const planning::PowerProgress& progress) {
  const fs::path file = file_of(arguments, progress.shard);
  const int runs = progress.shard.own_runs(progress.plan.runs);
  print(fmt::format("SIMULATED: shard {}/{}: {} of {} runs of each of {} sizes\nfile     {}\n",
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
  if (!arguments.folder.empty()) make_folder(arguments.folder);
  return print_report(arguments, all.progress);
}

int power(PowerArguments arguments) {
  if (!arguments.combine.empty()) return combine(arguments);
  if (arguments.study.empty()) {
    throw UsageError("power: STUDY is missing; give a study file, or shards with --combine");
  }
  planning::PowerPlan plan = arguments.plan;
  plan.participants = sizes_named(arguments.sizes);
  plan.stop_early = !arguments.no_early_stop;
  planning::settle(plan);
  const planning::Shard shard =
      arguments.has_shard ? shard_named(arguments.shard) : planning::Shard{};
  const PowerPreparation prepared(arguments, design::load_study(arguments.study));
  planning::PowerProgress progress = planning::new_progress(prepared.setting(), plan, shard);
  if (!arguments.folder.empty()) {
    make_folder(arguments.folder);
    progress = taken_up(file_of(arguments, shard), std::move(progress), arguments.resume);
  }
  make_missing_runs(prepared, arguments, progress);
  if (!arguments.has_shard) return print_report(arguments, progress);
  print_shard(arguments, progress);
  return 0;
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
  command
      .add_option("--methods", arguments.methods,
                  "The two methods to test, as A,B, if a comparison has more than two")
      ->delimiter(',');
  command.add_flag("--no-early-stop", arguments.no_early_stop,
                   "Make all runs, even if the result is already certain");
  command
      .add_option("--explorations", plan.explorations,
                  "Explorations of each stimulus from which trials draw")
      ->capture_default_str();
  command.add_option("--trainings", plan.trainings, "Trainings from which studies draw")
      ->capture_default_str();
  command.add_flag(
      "--servo", plan.servo,
      "Run every exploration through the servo, for comparison; some hundred times slower");
}

}  // namespace

void add_power_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<PowerArguments>();
  CLI::App* command = program.add_subcommand(
      "power",
      "Estimate power, type-I error and interval width of a study for an assumed sensitivity");
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
  // Shards contain their plan.
  for (CLI::Option* option : of_a_run) combine->excludes(option);
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] {
    arguments->has_shard = shard->count() > 0;
    action = [=] { return power(*arguments); };
  });
}

}  // namespace touchtrial::app
