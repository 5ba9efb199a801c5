// fit: estimates a subject model from answers.
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/recorded_pack.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "analysis/planning/answer_model.hpp"
#include "analysis/planning/fit_report.hpp"
#include "analysis/planning/subject_fit.hpp"
#include "analysis/report/text_figures.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/outputs.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "record/study_store.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct FitArguments {
  fs::path source;  ///< database; a study file with --accuracies
  fs::path key;
  fs::path pack;
  fs::path subject;
  std::string hand_device;
  fs::path out;
  std::vector<std::string> accuracies;
  std::vector<std::string> fixed;
  planning::FeltStudyOptions sampling;
  int participants = 20;
  int bootstraps = 499;
  bool json = false;
};

planning::FreeParameters free_parameters(const FitArguments& arguments) {
  const auto is_free = [&](const char* name) {
    return std::ranges::find(arguments.fixed, name) == arguments.fixed.end();
  };
  return {is_free("feature_noise"), is_free("lapse"), is_free("position"),
          is_free("classes"),       is_free("swaps"), is_free("spread")};
}

engine::Pack open_pack_for(const record::StudyStore& store, const study::StudyKey& key,
                           const FitArguments& arguments) {
  std::optional<engine::Pack> pack = analysis::pack_of(store, key, arguments.pack);
  if (!pack && key.simulated && arguments.pack.empty()) {
    prepare_simulated_pack(key);
    pack = analysis::pack_of(store, key, {});
  }
  if (pack) return std::move(*pack);
  const fs::path place = arguments.pack.empty() ? key.pack_folder : arguments.pack;
  throw FileError(one_line(place.string()) +
                  ": the pack of the study does not exist; name it with --pack");
}

planning::FitOrigin origin_of(const FitArguments& arguments, const study::Study& study,
                              const simulation::SubjectModel& subject) {
  planning::FitOrigin origin;
  origin.study = study.name;
  origin.subject = subject.source;
  origin.explorations = arguments.sampling.explorations;
  origin.directions = arguments.sampling.directions;
  origin.seed = arguments.sampling.seed;
  origin.felt_on = analysis::device_words({simulation::recorded_device(subject)});
  return origin;
}

/// Whether two paths name the same file, which need not exist yet.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path canonical = fs::weakly_canonical(a, error);
  return !error && canonical == fs::weakly_canonical(b, error);
}

/// Refuses an output that would replace an input or a foreign file.
void refuse_to_replace(const FitArguments& arguments) {
  if (arguments.out.empty()) return;
  const std::string place = "fit: -o " + one_line(arguments.out.string());
  std::vector<fs::path> inputs{arguments.key};
  for (const char* ending : {"", "-wal", "-shm", "-journal", ".key"}) {
    inputs.emplace_back(arguments.source.string() + ending);
  }
  const auto is_out = [&](const fs::path& input) {
    return !input.empty() && is_same_file(arguments.out, input);
  };
  if (std::ranges::any_of(inputs, is_out)) {
    throw UsageError(place + ": is one of the inputs; name another file");
  }
  require_output_path(arguments.out);
}

/// Prints the report before writing the file, so that a failed write does not lose it.
void print_and_write(const FitArguments& arguments, const simulation::SubjectModel& fitted,
                     const std::string& report) {
  print(report);
  if (!arguments.out.empty()) write_output(arguments.out, simulation::subject_model_json(fitted));
}

/// Shows progress from 0 to 1 on the bar.
planning::FitProgress progress_on(const std::function<void(int, int)>& bar) {
  constexpr int kSteps = 100;
  return [bar](double share) { bar(static_cast<int>(share * kSteps), kSteps); };
}

record::StudyStore open_unblinded(const fs::path& database) {
  record::StudyStore store =
      record::StudyStore::open(database, record::StudyStore::Access::read_only);
  if (!store.state().unblinded) {
    throw UsageError(one_line(database.string()) + ": " + blind_words(store.state()) +
                     ", and a fit needs outcomes; run `touchtrial close` and "
                     "`touchtrial unblind`");
  }
  return store;
}

planning::FitCounts counts_of(const FitArguments& arguments, const study::StudyKey& key,
                              const analysis::Outcomes& outcomes,
                              const std::map<int, study::Schedule>& schedules) {
  try {
    return planning::count_answers(outcomes, schedules, planning::stimuli_of(key));
  } catch (const StudyError& error) {
    throw StudyError(one_line(arguments.source.string()) + ": " + error.what());
  }
}

int fit_study(const FitArguments& arguments) {
  const record::StudyStore store = open_unblinded(arguments.source);
  const study::StudyKey key = key_of_database(store, arguments.source, arguments.key);
  const simulation::SubjectModel subject =
      subject_for(arguments.subject, key.study, arguments.hand_device);
  study::require_choice_of_classes(key.study, "fit");
  const analysis::Outcomes outcomes = analysis::load_outcomes(store, key);
  const planning::FitCounts counts =
      counts_of(arguments, key, outcomes,
                analysis::open_schedules(store, key, analysis::person_keys(store, key)));
  const engine::Pack pack = open_pack_for(store, key, arguments);
  const planning::AnswerModel model =
      planning::answer_model_of(key, pack, subject, arguments.sampling, progress_bar("feeling"));
  const planning::FitOptions options{free_parameters(arguments), arguments.bootstraps,
                                     arguments.sampling.seed, arguments.sampling.jobs};
  const planning::SubjectFit fit =
      planning::fit_subject(model, counts, subject, options, progress_on(progress_bar("fitting")));
  planning::FitOrigin origin = origin_of(arguments, key.study, subject);
  origin.simulated = outcomes.simulated;
  if (origin.simulated) origin.answers_on = analysis::simulated_devices(outcomes.collection);
  origin.pilot = outcomes.pilot;
  origin.interim = !outcomes.state.closed;
  print_and_write(
      arguments, fit.subject,
      arguments.json ? planning::fit_json(fit, origin) : planning::fit_text(fit, origin));
  return 0;
}

/// Parses "bark=0.87".
std::pair<std::string, double> parse_accuracy(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const auto share = equals == std::string::npos
                         ? std::nullopt
                         : number_in<double>(std::string_view(text).substr(equals + 1));
  if (!share || !(*share >= 0.0 && *share <= 1.0)) {
    throw UsageError("fit: --accuracies: " + in_quotes(text) +
                     " is not an accuracy; give CLASS=SHARE, for instance bark=0.87");
  }
  return {text.substr(0, equals), *share};
}

std::vector<double> accuracies_of(const FitArguments& arguments, const study::Study& study) {
  std::map<std::string, double> accuracy_by_class;
  for (const std::string& text : arguments.accuracies) {
    if (!accuracy_by_class.insert(parse_accuracy(text)).second) {
      throw UsageError("fit: --accuracies: a class occurs twice, in " + in_quotes(text));
    }
  }
  std::vector<double> accuracies;
  for (const study::StudyClass& texture : study.classes) {
    const auto entry = accuracy_by_class.find(texture.label);
    if (entry == accuracy_by_class.end()) {
      throw UsageError("fit: --accuracies: the study's class " + in_quotes(texture.label) +
                       " is missing; give one accuracy for each class");
    }
    accuracies.push_back(entry->second);
    accuracy_by_class.erase(entry);
  }
  if (accuracy_by_class.empty()) return accuracies;
  throw UsageError("fit: --accuracies: the study has no class " +
                   in_quotes(accuracy_by_class.begin()->first));
}

void refuse_database(const fs::path& path) {
  constexpr std::string_view kSignature = "SQLite format 3";
  std::string signature(kSignature.size(), ' ');
  std::ifstream file(path, std::ios::binary);
  if (file.read(signature.data(), static_cast<std::streamsize>(signature.size())) &&
      signature == kSignature) {
    throw UsageError(one_line(path.string()) +
                     ": is a database; fit --accuracies needs the study file");
  }
}

int fit_published(const FitArguments& arguments) {
  refuse_database(arguments.source);
  const study::Study study = study::load_study(arguments.source);
  study::require_choice_of_classes(study, "fit");
  const simulation::SubjectModel subject =
      subject_for(arguments.subject, study, arguments.hand_device);
  const std::vector<double> accuracies = accuracies_of(arguments, study);
  const study::StudyKey key = simulated_key(study, arguments.source);
  prepare_simulated_pack(key);
  const planning::AnswerModel model = planning::answer_model_of(
      key, engine::Pack(key.pack_folder), subject, arguments.sampling, progress_bar("feeling"));
  const planning::AccuracyFit fit = planning::fit_accuracies(
      model, accuracies, planning::layouts_of(study, arguments.participants), subject,
      free_parameters(arguments));
  const planning::FitOrigin origin = origin_of(arguments, study, subject);
  print_and_write(
      arguments, fit.subject,
      arguments.json ? planning::fit_json(fit, origin) : planning::fit_text(fit, origin));
  return 0;
}

int fit_subject(const FitArguments& arguments) {
  refuse_to_replace(arguments);
  return arguments.accuracies.empty() ? fit_study(arguments) : fit_published(arguments);
}

}  // namespace

void add_fit_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "fit",
                  "Estimate noise, lapses, biases and label swaps of a subject model from answers",
                  fit_subject);
  add_database_argument(command, arguments.source,
                        "Database of an unblinded study; with --accuracies a study file");
  command.add_option("--subject", arguments.subject,
                     "Subject model with the fixed parameters and the starting values (default: "
                     "built in)");
  add_on_option(command, arguments.hand_device);
  CLI::Option* key = add_key_option(command, arguments.key);
  CLI::Option* pack = command.add_option("--pack", arguments.pack, "Pack of the study");
  command.add_option("-o,--out", arguments.out, "Subject file to write");
  add_force_flag(command);
  command
      .add_option("--fix", arguments.fixed,
                  "Parameters fixed at the subject model's values: feature_noise, lapse, position, "
                  "classes, swaps, spread")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"feature_noise", "lapse", "position", "classes", "swaps", "spread"}));
  CLI::Option* accuracies =
      command
          .add_option("--accuracies", arguments.accuracies,
                      "Fit to published accuracies instead: CLASS=SHARE for each class")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->excludes(key)
          ->excludes(pack);
  command
      .add_option(
          "--participants", arguments.participants,
          "Number of participants over whose picture orders the published accuracies are averaged")
      ->check(CLI::Range(1, 1000))
      ->needs(accuracies)
      ->capture_default_str();
  add_count_option(command, "--explorations", arguments.sampling.explorations,
                   "Explorations of each stimulus from which answers are predicted", 8, 20000);
  add_count_option(command, "--bootstraps", arguments.bootstraps,
                   "Studies simulated from the fit, for p and intervals", 0, 100000);
  add_seed_option(command, arguments.sampling.seed,
                  "Seed of training (as in simulate), explorations and bootstrap");
  add_jobs_option(command, arguments.sampling.jobs);
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
