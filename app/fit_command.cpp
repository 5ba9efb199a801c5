#include "analysis/cues/study_plane.hpp"
#include "analysis/outcomes.hpp"
#include "analysis/planning/accuracy_fit.hpp"
#include "analysis/planning/felt_study.hpp"
#include "analysis/planning/fit_report.hpp"
#include "analysis/planning/subject_fit.hpp"
#include "analysis/sealed_sessions.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/key_of_database.hpp"
#include "app/simulated_study.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "protocols/session/subject_model_json.hpp"
#include "protocols/store/study_store.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string_view>
#include <system_error>
#include <thread>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct FitArguments {
  fs::path source;  ///< database; a study file with --accuracies
  fs::path key;
  fs::path pack;
  fs::path subject;
  fs::path out;
  std::vector<std::string> accuracies;
  std::vector<std::string> fixed;
  planning::FeltStudyOptions felt;
  int participants = 20;
  int bootstraps = 499;
  bool json = false;
};

planning::FreeParameters free_of(const FitArguments& arguments) {
  const auto is_free = [&](const char* name) {
    return std::ranges::find(arguments.fixed, name) == arguments.fixed.end();
  };
  return {is_free("weber"), is_free("lapse"), is_free("position"), is_free("classes"),
          is_free("swaps")};
}

engine::Pack pack_for(const store::StudyStore& store, const design::StudyKey& key,
                      const FitArguments& arguments) {
  std::optional<engine::Pack> pack = analysis::pack_of(store, key, arguments.pack);
  if (!pack && key.simulated && arguments.pack.empty()) {
    prepare_simulated_pack(key);
    pack = analysis::pack_of(store, key, {});
  }
  if (pack) return std::move(*pack);
  const fs::path place = arguments.pack.empty() ? key.pack_folder : arguments.pack;
  throw FileError(one_line(place.string()) +
                  ": the pack that the study was felt with is not there; name it with --pack");
}

planning::FitOrigin origin_of(const FitArguments& arguments, const design::Study& study,
                              const session::SubjectModel& subject) {
  planning::FitOrigin origin;
  origin.study = study.name;
  origin.subject = subject.source;
  origin.explorations = arguments.felt.explorations;
  origin.directions = arguments.felt.directions;
  origin.seed = arguments.felt.seed;
  return origin;
}

bool is_subject_file(const fs::path& path) {
  try {
    static_cast<void>(session::load_subject_model(path));
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

/// Also by another name, and where nothing is there yet.
bool same_file(const fs::path& one, const fs::path& other) {
  std::error_code error;
  if (fs::equivalent(one, other, error)) return true;
  const fs::path whole = fs::weakly_canonical(one, error);
  return !error && whole == fs::weakly_canonical(other, error);
}

/// The subject file replaces what is there, so that may only be another subject file.
void refuse_to_replace(const FitArguments& arguments) {
  if (arguments.out.empty()) return;
  const std::string place = "fit: -o " + one_line(arguments.out.string());
  std::vector<fs::path> inputs{arguments.key};
  for (const char* ending : {"", "-wal", "-shm", "-journal", ".key"}) {
    inputs.emplace_back(arguments.source.string() + ending);
  }
  const auto is_out = [&](const fs::path& input) {
    return !input.empty() && same_file(arguments.out, input);
  };
  if (std::ranges::any_of(inputs, is_out)) {
    throw UsageError(place + ": belongs to what is fitted; name another file");
  }
  std::error_code error;
  const fs::file_status status = fs::symlink_status(arguments.out, error);
  if (status.type() != fs::file_type::not_found && !is_subject_file(arguments.out)) {
    throw UsageError(place + ": is there, and is no subject file; name another file");
  }
}

/// What took a minute to work out is printed before a file may fail.
void finish(const FitArguments& arguments, const session::SubjectModel& fitted,
            const std::string& report) {
  print(report);
  if (!arguments.out.empty()) replace_file(arguments.out, session::subject_model_json(fitted));
}

/// Coarse stages of one bar.
planning::FitProgress shares(const std::function<void(int, int)>& bar) {
  constexpr int kWhole = 100;
  return [bar](double share) { bar(static_cast<int>(share * kWhole), kWhole); };
}

store::StudyStore unblinded(const fs::path& database) {
  store::StudyStore store = store::StudyStore::open(database, store::StudyStore::Access::read_only);
  if (!store.state().unblinded) {
    throw UsageError(one_line(database.string()) +
                     ": not unblinded, and a fit is of outcomes; run `touchtrial close` and "
                     "`touchtrial unblind`");
  }
  return store;
}

planning::FitCounts counts_of(const FitArguments& arguments, const design::StudyKey& key,
                              const analysis::Outcomes& outcomes,
                              const std::map<int, design::Schedule>& schedules) {
  try {
    return planning::count_answers(outcomes, schedules, planning::stimuli_of(key));
  } catch (const StudyError& error) {
    throw StudyError(one_line(arguments.source.string()) + ": " + error.what());
  }
}

int fit_study(const FitArguments& arguments) {
  const store::StudyStore store = unblinded(arguments.source);
  const design::StudyKey key = key_of_database(store, arguments.source, arguments.key);
  const session::SubjectModel subject = subject_for(arguments.subject, key.study);
  const analysis::Outcomes outcomes = analysis::load_outcomes(store, key);
  const planning::FitCounts counts =
      counts_of(arguments, key, outcomes, analysis::open_schedules(store, key));
  const engine::Pack pack = pack_for(store, key, arguments);
  const planning::AnswerModel model =
      planning::answer_model_of(key, pack, subject, arguments.felt, progress_bar("feeling"));
  const planning::FitOptions options{free_of(arguments), arguments.bootstraps, arguments.felt.seed,
                                     arguments.felt.jobs};
  const planning::SubjectFit fit =
      planning::fit_subject(model, counts, subject, options, shares(progress_bar("fitting")));
  planning::FitOrigin origin = origin_of(arguments, key.study, subject);
  origin.simulated = outcomes.simulated;
  origin.pilot = outcomes.pilot;
  origin.interim = !outcomes.state.closed;
  finish(arguments, fit.subject,
         arguments.json ? planning::fit_json(fit, origin) : planning::fit_text(fit, origin));
  return 0;
}

/// "bark=0.87"
std::pair<std::string, double> accuracy_of(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  double share = -1.0;
  if (equals != std::string::npos) {
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + equals + 1, end, share);
    if (read.ec != std::errc() || read.ptr != end) share = -1.0;
  }
  if (!(share >= 0.0 && share <= 1.0)) {
    throw UsageError("fit: --accuracies: " + in_quotes(text) +
                     " is no accuracy; give CLASS=SHARE, for instance bark=0.87");
  }
  return {text.substr(0, equals), share};
}

std::vector<double> accuracies_of(const FitArguments& arguments, const design::Study& study) {
  std::map<std::string, double> given;
  for (const std::string& text : arguments.accuracies) {
    if (!given.insert(accuracy_of(text)).second) {
      throw UsageError("fit: --accuracies: a class is there twice, in " + in_quotes(text));
    }
  }
  std::vector<double> accuracies;
  for (const design::StudyClass& one : study.classes) {
    const auto found = given.find(one.label);
    if (found == given.end()) {
      throw UsageError("fit: --accuracies: the study's class " + in_quotes(one.label) +
                       " has none; give one for each class");
    }
    accuracies.push_back(found->second);
    given.erase(found);
  }
  if (given.empty()) return accuracies;
  throw UsageError("fit: --accuracies: the study has no class " + in_quotes(given.begin()->first));
}

void refuse_database(const fs::path& path) {
  constexpr std::string_view kStart = "SQLite format 3";
  std::string start(kStart.size(), ' ');
  std::ifstream file(path, std::ios::binary);
  if (file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kStart) {
    throw UsageError(one_line(path.string()) +
                     ": is a database; fit --accuracies wants the study file");
  }
}

int fit_published(const FitArguments& arguments) {
  refuse_database(arguments.source);
  const design::Study study = design::load_study(arguments.source);
  const session::SubjectModel subject = subject_for(arguments.subject, study);
  const std::vector<double> wanted = accuracies_of(arguments, study);
  const design::StudyKey key = simulated_key(study, arguments.source);
  prepare_simulated_pack(key);
  const planning::AnswerModel model = planning::answer_model_of(
      key, engine::Pack(key.pack_folder), subject, arguments.felt, progress_bar("feeling"));
  const planning::AccuracyFit fit =
      planning::fit_accuracies(model, wanted, planning::layouts_of(study, arguments.participants),
                               subject, free_of(arguments));
  const planning::FitOrigin origin = origin_of(arguments, study, subject);
  finish(arguments, fit.subject,
         arguments.json ? planning::fit_json(fit, origin) : planning::fit_text(fit, origin));
  return 0;
}

}  // namespace

void add_fit_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<FitArguments>();
  arguments->felt.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  CLI::App* command = program.add_subcommand(
      "fit", "Estimate noise, lapses, biases and label swaps of a subject model from answers");
  command
      ->add_option("DB", arguments->source,
                   "Database of an unblinded study; with --accuracies a study file")
      ->required();
  command->add_option("--subject", arguments->subject,
                      "Subject model with what is not estimated, and where to start (default: "
                      "built in)");
  auto* key = command->add_option("--key", arguments->key, "Key of the study (default: DB.key)");
  auto* pack = command->add_option("--pack", arguments->pack, "Pack of the study");
  command->add_option("-o,--out", arguments->out, "Subject file to write");
  command
      ->add_option("--fix", arguments->fixed,
                   "What stays as the subject model has it: weber, lapse, position, classes, swaps")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"weber", "lapse", "position", "classes", "swaps"}));
  auto* accuracies =
      command
          ->add_option("--accuracies", arguments->accuracies,
                       "Fit to published accuracies instead: CLASS=SHARE for each class")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->excludes(key)
          ->excludes(pack);
  command
      ->add_option("--participants", arguments->participants,
                   "Whose orders of pictures published accuracies are of")
      ->check(CLI::Range(1, 1000))
      ->needs(accuracies)
      ->capture_default_str();
  command
      ->add_option("--explorations", arguments->felt.explorations,
                   "Of each stimulus, felt to work out what is answered")
      ->check(CLI::Range(8, 20000))
      ->capture_default_str();
  command
      ->add_option("--bootstraps", arguments->bootstraps,
                   "Studies simulated from the fit, for its p and intervals")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command
      ->add_option("--seed", arguments->felt.seed,
                   "Seed of training (as simulate's), explorations and bootstrap")
      ->check(seed_validator())
      ->capture_default_str();
  command->add_option("--jobs", arguments->felt.jobs, "Threads; results do not depend on them")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "One JSON object in place of tables");
  command->callback([=, &action] {
    action = [=] {
      refuse_to_replace(*arguments);
      return arguments->accuracies.empty() ? fit_study(*arguments) : fit_published(*arguments);
    };
  });
}

}  // namespace touchtrial::app
